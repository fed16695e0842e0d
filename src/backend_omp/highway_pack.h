#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "shared.h"

// What Packs of either precision share: included by highway_single.h and highway_double.h, which say what Scalar is.

namespace squall::openmp {

namespace {  // each instruction set and precision has a Pack of its own

namespace hn = hwy::HWY_NAMESPACE;

/// A vector of Scalars with the operators that the formulas use; one instruction each.
using Scalars = hn::ScalableTag<Scalar>;
using Bits = hn::RebindToSigned<Scalars>;

struct Mask {
  hn::Mask<Scalars> lanes;
  friend HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.lanes, b.lanes)}; }
  friend HWY_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.lanes, b.lanes)}; }
};
/// max0 of shared.h: the signed maximum of the bits, or what comes to the same, none for a sign bit: 64-bit integers
/// have no maximum in AVX2.
HWY_INLINE hn::Vec<Scalars> max0_lanes(hn::Vec<Scalars> a) {
  if constexpr (sizeof(Scalar) == sizeof(float))
    return hn::BitCast(Scalars(), hn::Max(hn::BitCast(Bits(), a), hn::Zero(Bits())));
  else
    return hn::ZeroIfNegative(a);
}
HWY_INLINE bool any(Mask m) { return !hn::AllFalse(Scalars(), m.lanes); }
/// Whether `m` holds in every lane of `valid`.
HWY_INLINE bool all(Mask m, Mask valid) { return hn::AllFalse(Scalars(), hn::AndNot(m.lanes, valid.lanes)); }

struct Pack {
  static constexpr int k_lanes = HWY_LANES(Scalar);
  static constexpr bool k_many_registers = HWY_STATIC_TARGET <= HWY_AVX3;
  hn::Vec<Scalars> lanes;

  Pack() = default;
  HWY_INLINE explicit Pack(Scalar value) : lanes(hn::Set(Scalars(), value)) {}
  HWY_INLINE explicit Pack(hn::Vec<Scalars> value) : lanes(value) {}
  static HWY_INLINE Pack load(const Scalar* from) { return Pack(hn::LoadU(Scalars(), from)); }
  HWY_INLINE void store(Scalar* to) const { hn::StoreU(lanes, Scalars(), to); }

  friend HWY_INLINE Pack operator+(Pack a, Pack b) { return Pack(hn::Add(a.lanes, b.lanes)); }
  friend HWY_INLINE Pack operator-(Pack a, Pack b) { return Pack(hn::Sub(a.lanes, b.lanes)); }
  friend HWY_INLINE Pack operator*(Pack a, Pack b) { return Pack(hn::Mul(a.lanes, b.lanes)); }
  friend HWY_INLINE Pack operator/(Pack a, Pack b) { return Pack(hn::Div(a.lanes, b.lanes)); }
  friend HWY_INLINE Pack operator-(Pack a) { return Pack(hn::Neg(a.lanes)); }
  friend HWY_INLINE Mask operator<(Pack a, Pack b) { return {hn::Lt(a.lanes, b.lanes)}; }
  friend HWY_INLINE Pack fma(Pack a, Pack b, Pack c) { return Pack(hn::MulAdd(a.lanes, b.lanes, c.lanes)); }
  friend HWY_INLINE Pack nfma(Pack a, Pack b, Pack c) { return Pack(hn::NegMulAdd(a.lanes, b.lanes, c.lanes)); }
  friend HWY_INLINE Pack fms(Pack a, Pack b, Pack c) { return Pack(hn::MulSub(a.lanes, b.lanes, c.lanes)); }
  friend HWY_INLINE Pack sqrt(Pack a) { return Pack(hn::Sqrt(a.lanes)); }
  friend HWY_INLINE Pack max0(Pack a) { return Pack(max0_lanes(a.lanes)); }
};
HWY_INLINE Pack smaller(Pack a, Pack b) { return Pack(hn::Min(a.lanes, b.lanes)); }
HWY_INLINE Pack larger(Pack a, Pack b) { return Pack(hn::Max(a.lanes, b.lanes)); }
HWY_INLINE Mask first_lanes(int count) { return {hn::FirstN(Scalars(), static_cast<std::size_t>(count))}; }
HWY_INLINE Pack select(Mask m, Pack yes, Pack no) { return Pack(hn::IfThenElse(m.lanes, yes.lanes, no.lanes)); }
HWY_INLINE Scalar first_lane(Pack a) { return hn::GetLane(a.lanes); }
HWY_INLINE Pack smallest_lane(Pack a) { return Pack(hn::MinOfLanes(Scalars(), a.lanes)); }
HWY_INLINE Pack largest_lane(Pack a) { return Pack(hn::MaxOfLanes(Scalars(), a.lanes)); }

/// Scalars in a block: vectors meet records of 8 Scalars in blocks of 16 bytes.
static constexpr int k_block = 16 / static_cast<int>(sizeof(Scalar));

/// The block at `from` and those k_block, 2 k_block, ... records further, as many as a vector holds.
HWY_INLINE hn::Vec<Scalars> load_blocks(const Scalar* from) {
  const hn::FixedTag<Scalar, k_block> block;
  const hn::FixedTag<Scalar, 2 * k_block> two;
  const auto low = hn::Combine(two, hn::LoadU(block, from + 8 * k_block), hn::LoadU(block, from));
#if HWY_STATIC_TARGET <= HWY_AVX3
  const auto high = hn::Combine(two, hn::LoadU(block, from + 24 * k_block), hn::LoadU(block, from + 16 * k_block));
  return hn::Combine(Scalars(), high, low);
#else
  return low;
#endif
}
HWY_INLINE void store_blocks(hn::Vec<Scalars> blocks, Scalar* to) {
  const hn::FixedTag<Scalar, k_block> block;
#if HWY_STATIC_TARGET <= HWY_AVX3
  const hn::FixedTag<Scalar, 2 * k_block> two;
  const auto high = hn::UpperHalf(two, blocks);
  hn::StoreU(hn::LowerHalf(block, high), block, to + 16 * k_block);
  hn::StoreU(hn::UpperHalf(block, high), block, to + 24 * k_block);
  const auto low = hn::LowerHalf(two, blocks);
#else
  const auto low = blocks;
#endif
  hn::StoreU(hn::LowerHalf(block, low), block, to);
  hn::StoreU(hn::UpperHalf(block, low), block, to + 8 * k_block);
}

/// k_block vectors of blocks: lane i of block b of vector f becomes lane f of block b of vector i. Each precision's
/// own.
HWY_INLINE void transpose_blocks(const hn::Vec<Scalars>* from, hn::Vec<Scalars>* to);

/// Half the fields of k_lanes records of 8 Scalars: fields[f] has Scalar `first` + f of every record, one lane each;
/// `first` is 0 or 4.
HWY_INLINE void load_fields(const Scalar* records, int first, Pack* fields) {
  for (int f = 0; f < 4; f += k_block) {
    hn::Vec<Scalars> blocks[k_block], columns[k_block];
    for (int i = 0; i < k_block; ++i) blocks[i] = load_blocks(records + 8 * i + first + f);
    transpose_blocks(blocks, columns);
    for (int i = 0; i < k_block; ++i) fields[f + i] = Pack(columns[i]);
  }
}
HWY_INLINE void store_fields(Scalar* records, int first, const Pack* fields) {
  for (int f = 0; f < 4; f += k_block) {
    hn::Vec<Scalars> blocks[k_block], columns[k_block];
    for (int i = 0; i < k_block; ++i) columns[i] = fields[f + i].lanes;
    transpose_blocks(columns, blocks);
    for (int i = 0; i < k_block; ++i) store_blocks(blocks[i], records + 8 * i + first + f);
  }
}

/// The numbers of the bits that are set in a byte, lowest first.
struct SetBits {
  std::uint8_t numbers[256][8] = {};
  constexpr SetBits() {
    for (unsigned byte = 0; byte < 256; ++byte)
      for (unsigned bit = 0, count = 0; bit < 8; ++bit)
        if ((byte >> bit & 1u) != 0) numbers[byte][count++] = static_cast<std::uint8_t>(bit);
  }
};
[[maybe_unused]] static constexpr SetBits k_set_bits;

/// convergence_term of numbers that are 0 or above and at most 1024: below 2^52 a double holds integers and, 3 *
/// 2^51 added, rounds to them and shows them in its bits.
template <class Doubles>
HWY_INLINE auto rounded_terms(Doubles d, hn::Vec<Doubles> errors) {
  const hn::RebindToSigned<Doubles> integers;
  const auto shift = hn::Set(d, 6755399441055744.0);
  const auto scaled = hn::Mul(errors, hn::Set(d, 4294967296.0));
  return hn::Sub(hn::BitCast(integers, hn::Add(scaled, shift)), hn::BitCast(integers, shift));
}

/// Errors as convergence_term clamps them; 0 in lanes that are not valid.
HWY_INLINE hn::Vec<Scalars> clamped_errors(Pack error, Mask valid) {
  const Scalars d;
  const auto counted = hn::And(valid.lanes, hn::Lt(hn::Zero(d), error.lanes));
  return hn::Min(hn::IfThenElseZero(counted, error.lanes), hn::Set(d, Scalar(1024)));
}

}  // namespace

}  // namespace squall::openmp
