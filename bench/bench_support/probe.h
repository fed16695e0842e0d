#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/settings.h"

namespace squall::bench {

/// What an arithmetic unit is asked to do. `mixed` is as many multiplications as additions: processors with separate
/// adders do more of both together than of either alone.
enum class Operation { fma, multiply, add, mixed, square_root, divide };
inline constexpr std::array k_operations{Operation::fma,   Operation::multiply,    Operation::add,
                                         Operation::mixed, Operation::square_root, Operation::divide};
const char* to_string(Operation operation);

/// McCalpin's STREAM: copy a = b, scale a = s b, triad a = b + s c.
enum class Stream { copy, scale, triad };
inline constexpr std::array k_streams{Stream::copy, Stream::scale, Stream::triad};
const char* to_string(Stream stream);
/// Bytes moved per element as the loop names them; what a cache reads to be able to write is not counted.
std::size_t bytes_per_element(Stream stream);

/// The probes compiled for one instruction set.
struct Probe {
  int lanes;
  /// Instructions in a round of arithmetic(): all independent of each other, enough to hide their latency.
  int (*per_round)(Operation operation);
  /// nothing: 0. Returns a number that depends on every instruction.
  float (*arithmetic)(Operation operation, std::int64_t rounds, float nothing);
  /// count: elements, a multiple of 64.
  void (*stream)(Stream stream, float* a, const float* b, const float* c, std::size_t count, float factor);
};

/// For an instruction set that is available (openmp::available_simd).
const Probe& probe_for(Simd simd);

const Probe& scalar_probe();
const Probe& avx2_probe();
const Probe& avx512_probe();

}  // namespace squall::bench
