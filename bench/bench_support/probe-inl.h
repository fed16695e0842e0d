#pragma once

// Included once per instruction set, after its Pack. Nothing here has external linkage: code compiled for one
// instruction set must not be picked by the linker for another.

#include "bench_support/probe.h"

namespace squall::bench {

namespace {

// Independent chains: latency times throughput of the units that exist (4 cycles, 2 a cycle). Both kinds together fill
// the sixteen registers of AVX2, so no operand is a constant.
static constexpr int k_chains = 8;

/// Starts at -0.5, from where fma creeps towards 0, at 1 and at 0, which stay: no number gets out of hand. `nothing` is
/// 0, which the compiler must not know: it would compute equal chains once.
template <class Pack, bool fuses, bool multiplies, bool adds>
Pack fast_operations(std::int64_t rounds, Pack start, float nothing) {
  // NOLINTNEXTLINE(misc-redundant-expression): constants are what the compiler must not see
  const Pack zero = start - start, one = zero - (start + start);
  Pack fused[k_chains], products[k_chains], sums[k_chains];
  for (int chain = 0; chain < k_chains; ++chain) {
    const Pack apart(nothing * static_cast<float>(chain));
    fused[chain] = start + apart;
    products[chain] = one + apart;
    sums[chain] = zero + apart;
  }
  for (std::int64_t round = 0; round < rounds; ++round) {
    if constexpr (fuses)
      for (auto& value : fused) value = fma(value, value, value);
    if constexpr (multiplies)
      for (auto& value : products) value = value * value;
    if constexpr (adds)
      for (auto& value : sums) value = value + value;
  }
  Pack total = zero;
  for (auto& value : fused) total = total + value;
  for (auto& value : products) total = total + value;
  for (auto& value : sums) total = total + value;
  return total;
}

/// An addition before each keeps the operands from becoming round numbers; it has units of its own.
template <class Pack, bool divides>
Pack roots_or_quotients(std::int64_t rounds, Pack start, float nothing) {
  Pack values[k_chains];
  for (int chain = 0; chain < k_chains; ++chain) values[chain] = start + Pack(nothing * static_cast<float>(chain));
  for (std::int64_t round = 0; round < rounds; ++round)
    for (auto& value : values) {
      const Pack next = value + start;
      if constexpr (divides)
        value = start / next;
      else
        value = sqrt(next);
    }
  Pack total = start;
  for (auto& value : values) total = total + value;
  return total;
}

template <class Pack>
struct ProbeOf {
  static int per_round(Operation operation) { return operation == Operation::mixed ? 2 * k_chains : k_chains; }

  static float arithmetic(Operation operation, std::int64_t rounds, float nothing) {
    const Pack minus_half(-0.5f + nothing), start(1.7f);
    alignas(64) float lanes[Pack::k_lanes];
    const auto result = [&] {
      switch (operation) {
        case Operation::fma:
          return fast_operations<Pack, true, false, false>(rounds, minus_half, nothing);
        case Operation::multiply:
          return fast_operations<Pack, false, true, false>(rounds, minus_half, nothing);
        case Operation::add:
          return fast_operations<Pack, false, false, true>(rounds, minus_half, nothing);
        case Operation::mixed:
          return fast_operations<Pack, false, true, true>(rounds, minus_half, nothing);
        case Operation::square_root:
          return roots_or_quotients<Pack, false>(rounds, start, nothing);
        case Operation::divide:
          return roots_or_quotients<Pack, true>(rounds, start, nothing);
      }
      return start;
    };
    result().store(lanes);
    return lanes[0];
  }

  static void stream(Stream stream, float* a, const float* b, const float* c, std::size_t count, float factor) {
    const Pack s(factor);
    const auto run = [&](auto value) {
      for (std::size_t i = 0; i < count; i += 4 * Pack::k_lanes)
        for (std::size_t part = 0; part < 4; ++part) {
          const std::size_t at = i + part * Pack::k_lanes;
          value(at).store(a + at);
        }
    };
    if (stream == Stream::copy) run([&](std::size_t i) { return Pack::load(b + i); });
    if (stream == Stream::scale) run([&](std::size_t i) { return s * Pack::load(b + i); });
    if (stream == Stream::triad) run([&](std::size_t i) { return Pack::load(b + i) + s * Pack::load(c + i); });
  }

  static const Probe& table() {
    static constexpr Probe k_table{Pack::k_lanes, per_round, arithmetic, stream};
    return k_table;
  }
};

}  // namespace

}  // namespace squall::bench
