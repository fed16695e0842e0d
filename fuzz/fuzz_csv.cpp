// Particle files: any text is particles or an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/csv.h"
#include "core/errors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const squall::Particles particles = squall::parse_particle_csv(text, "fuzz.csv");
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (!particles.positions[i].allFinite() || !particles.velocities[i].allFinite()) std::abort();
  } catch (const squall::InputError&) {
  }
  return 0;
}
