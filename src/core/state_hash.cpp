#include "core/state_hash.h"

#include <bit>
#include <cstdio>

#include "core/mix.h"

namespace squall {

namespace {

std::uint64_t bits_of(double value, Precision precision) {
  return precision == Precision::single_precision ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                                  : std::bit_cast<std::uint64_t>(value);
}

}  // namespace

std::uint64_t state_hash(const Particles& particles, Precision precision) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    std::uint64_t chain = mix64(particles.ids[i]);
    for (int axis = 0; axis < 3; ++axis) chain = mix64(chain ^ bits_of(particles.positions[i][axis], precision));
    for (int axis = 0; axis < 3; ++axis) chain = mix64(chain ^ bits_of(particles.velocities[i][axis], precision));
    sum += chain;
  }
  return sum;
}

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace squall
