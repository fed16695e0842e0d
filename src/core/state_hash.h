#pragma once

#include <cstdint>
#include <string>

#include "core/particles.h"
#include "core/settings.h"

namespace squall {

/// Order-free hash of a state: the sum of a 64-bit mix of each particle's id and the bits of its position and velocity,
/// in the precision it was computed in. Equal hashes mean equal water.
std::uint64_t state_hash(const Particles& particles, Precision precision);

/// 16 hex digits.
std::string hash_text(std::uint64_t hash);

}  // namespace squall
