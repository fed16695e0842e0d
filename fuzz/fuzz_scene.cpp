// Scene files: any text is a scene or an InputError, and a scene survives being printed.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/errors.h"
#include "core/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Files that a scene names are not this fuzzer's, and could be anything on this machine.
  if (text.find("particles") != std::string::npos && text.find("file") != std::string::npos) return 0;
  try {
    const squall::Scene scene = squall::parse_scene(text, "fuzz.toml");
    const std::string printed = squall::print_scene(scene);
    if (squall::print_scene(squall::parse_scene(printed, "fuzz.toml")) != printed) std::abort();
    static_cast<void>(squall::particle_capacity(scene));
  } catch (const squall::InputError&) {
  }
  return 0;
}
