#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "shared.h"

namespace squall::openmp {

namespace {  // each instruction set has a Pack of its own

namespace hn = hwy::HWY_NAMESPACE;

/// A vector of floats with the operators that the formulas use; one instruction each.
using Floats = hn::ScalableTag<float>;
using Bits = hn::RebindToSigned<Floats>;

struct Mask {
  hn::Mask<Floats> lanes;
  friend HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.lanes, b.lanes)}; }
  friend HWY_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.lanes, b.lanes)}; }
};
HWY_INLINE bool any(Mask m) { return !hn::AllFalse(Floats(), m.lanes); }
/// Whether `m` holds in every lane of `valid`.
HWY_INLINE bool all(Mask m, Mask valid) { return hn::AllFalse(Floats(), hn::AndNot(m.lanes, valid.lanes)); }

struct Pack {
  static constexpr int k_lanes = HWY_LANES(float);
  static constexpr bool k_many_registers = HWY_STATIC_TARGET <= HWY_AVX3;
  hn::Vec<Floats> lanes;

  Pack() = default;
  HWY_INLINE explicit Pack(float value) : lanes(hn::Set(Floats(), value)) {}
  HWY_INLINE explicit Pack(hn::Vec<Floats> value) : lanes(value) {}
  static HWY_INLINE Pack load(const float* from) { return Pack(hn::LoadU(Floats(), from)); }
  HWY_INLINE void store(float* to) const { hn::StoreU(lanes, Floats(), to); }

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
  friend HWY_INLINE Pack max0(Pack a) {
    return Pack(hn::BitCast(Floats(), hn::Max(hn::BitCast(Bits(), a.lanes), hn::Zero(Bits()))));
  }
};
HWY_INLINE Pack smaller(Pack a, Pack b) { return Pack(hn::Min(a.lanes, b.lanes)); }
HWY_INLINE Pack larger(Pack a, Pack b) { return Pack(hn::Max(a.lanes, b.lanes)); }
HWY_INLINE Mask first_lanes(int count) { return {hn::FirstN(Floats(), static_cast<std::size_t>(count))}; }
HWY_INLINE Pack select(Mask m, Pack yes, Pack no) { return Pack(hn::IfThenElse(m.lanes, yes.lanes, no.lanes)); }
HWY_INLINE float first_lane(Pack a) { return hn::GetLane(a.lanes); }
HWY_INLINE Pack smallest_lane(Pack a) { return Pack(hn::MinOfLanes(Floats(), a.lanes)); }
HWY_INLINE Pack largest_lane(Pack a) { return Pack(hn::MaxOfLanes(Floats(), a.lanes)); }

#if HWY_STATIC_TARGET > HWY_AVX3
/// The numbers of the bits that are set in a byte, lowest first.
struct SetBits {
  std::uint8_t numbers[256][8] = {};
  constexpr SetBits() {
    for (unsigned byte = 0; byte < 256; ++byte)
      for (unsigned bit = 0, count = 0; bit < 8; ++bit)
        if ((byte >> bit & 1u) != 0) numbers[byte][count++] = static_cast<std::uint8_t>(bit);
  }
};
constexpr SetBits k_set_bits;
#endif

/// Writes first + lane for the lanes of `m` below `limit`, packed; scribbles over k_lanes entries. Returns how many.
HWY_INLINE int append_lanes(int* list, int first, Mask m, int limit) {
  const Bits d;
#if HWY_STATIC_TARGET > HWY_AVX3
  std::uint8_t bits = 0;
  hn::StoreMaskBits(Floats(), m.lanes, &bits);
  if (limit < Pack::k_lanes) bits = static_cast<std::uint8_t>(bits & ((1u << limit) - 1u));
  const auto lanes = hn::PromoteTo(d, hn::LoadU(hn::FixedTag<std::uint8_t, 8>(), k_set_bits.numbers[bits]));
  hn::StoreU(hn::Add(lanes, hn::Set(d, first)), d, list);
  return __builtin_popcount(bits);
#else
  const auto mask = hn::RebindMask(d, hn::And(m.lanes, first_lanes(limit).lanes));
  hn::StoreU(hn::Compress(hn::Add(hn::Iota(d, 0), hn::Set(d, first)), mask), d, list);
  return static_cast<int>(hn::CountTrue(d, mask));
#endif
}

/// Four vectors, each blocks of four floats: lane i of block b of vector f becomes lane f of block b of vector i.
HWY_INLINE void transpose_blocks(const hn::Vec<Floats>* from, hn::Vec<Floats>* to) {
  const Floats d;
  const hn::RepartitionToWide<Floats> wide;
  const auto low_0 = hn::BitCast(wide, hn::InterleaveLower(d, from[0], from[1]));
  const auto low_1 = hn::BitCast(wide, hn::InterleaveLower(d, from[2], from[3]));
  const auto high_0 = hn::BitCast(wide, hn::InterleaveUpper(d, from[0], from[1]));
  const auto high_1 = hn::BitCast(wide, hn::InterleaveUpper(d, from[2], from[3]));
  to[0] = hn::BitCast(d, hn::InterleaveLower(wide, low_0, low_1));
  to[1] = hn::BitCast(d, hn::InterleaveUpper(wide, low_0, low_1));
  to[2] = hn::BitCast(d, hn::InterleaveLower(wide, high_0, high_1));
  to[3] = hn::BitCast(d, hn::InterleaveUpper(wide, high_0, high_1));
}

/// Blocks of four floats, 4 records of 8 floats apart.
HWY_INLINE hn::Vec<Floats> load_blocks(const float* from) {
  const hn::FixedTag<float, 4> block;
  const hn::FixedTag<float, 8> two;
  const auto low = hn::Combine(two, hn::LoadU(block, from + 32), hn::LoadU(block, from));
#if HWY_STATIC_TARGET <= HWY_AVX3
  return hn::Combine(Floats(), hn::Combine(two, hn::LoadU(block, from + 96), hn::LoadU(block, from + 64)), low);
#else
  return low;
#endif
}
HWY_INLINE void store_blocks(hn::Vec<Floats> blocks, float* to) {
  const hn::FixedTag<float, 4> block;
#if HWY_STATIC_TARGET <= HWY_AVX3
  const hn::FixedTag<float, 8> two;
  const auto high = hn::UpperHalf(two, blocks);
  hn::StoreU(hn::LowerHalf(block, high), block, to + 64);
  hn::StoreU(hn::UpperHalf(block, high), block, to + 96);
  const auto low = hn::LowerHalf(two, blocks);
#else
  const auto low = blocks;
#endif
  hn::StoreU(hn::LowerHalf(block, low), block, to);
  hn::StoreU(hn::UpperHalf(block, low), block, to + 32);
}

/// Half the fields of k_lanes records of 8 floats: fields[f] has float `first` + f of every record, one lane each;
/// `first` is 0 or 4.
HWY_INLINE void load_fields(const float* records, int first, Pack* fields) {
  hn::Vec<Floats> blocks[4], columns[4];
  for (int i = 0; i < 4; ++i) blocks[i] = load_blocks(records + 8 * i + first);
  transpose_blocks(blocks, columns);
  for (int f = 0; f < 4; ++f) fields[f] = Pack(columns[f]);
}
HWY_INLINE void store_fields(float* records, int first, const Pack* fields) {
  hn::Vec<Floats> blocks[4], columns[4];
  for (int f = 0; f < 4; ++f) columns[f] = fields[f].lanes;
  transpose_blocks(columns, blocks);
  for (int i = 0; i < 4; ++i) store_blocks(blocks[i], records + 8 * i + first);
}

/// Half the fields of one record, each in all lanes.
HWY_INLINE void broadcast_fields(const float* record, int first, Pack* fields) {
  const auto four = hn::LoadDup128(Floats(), record + first);
  fields[0] = Pack(hn::Broadcast<0>(four));
  fields[1] = Pack(hn::Broadcast<1>(four));
  fields[2] = Pack(hn::Broadcast<2>(four));
  fields[3] = Pack(hn::Broadcast<3>(four));
}

/// Sum of convergence_term over the lanes of `valid`: below 2^52 a double holds integers and, 3 * 2^51 added, rounds to
/// them and shows them in its bits.
HWY_INLINE std::int64_t sum_of_terms(Pack error, Mask valid) {
  const Floats d;
  const hn::RepartitionToWide<Floats> wide;
  const hn::RebindToSigned<decltype(wide)> integers;
  const auto counted = hn::And(valid.lanes, hn::Lt(hn::Zero(d), error.lanes));
  const auto clamped = hn::Min(hn::IfThenElseZero(counted, error.lanes), hn::Set(d, 1024.0f));
  const auto shift = hn::Set(wide, 6755399441055744.0);
  const auto rounded = [&](auto half) {
    const auto scaled = hn::Mul(hn::PromoteTo(wide, half), hn::Set(wide, 4294967296.0));
    return hn::Sub(hn::BitCast(integers, hn::Add(scaled, shift)), hn::BitCast(integers, shift));
  };
  const hn::Half<Floats> half;
  const auto sums = hn::Add(rounded(hn::LowerHalf(half, clamped)), rounded(hn::UpperHalf(half, clamped)));
  return hn::GetLane(hn::SumOfLanes(integers, sums));
}

/// A cell coordinate per lane.
struct Cells {
  hn::Vec<Bits> lanes;
  HWY_INLINE void store(int* to) const { hn::StoreU(lanes, Bits(), to); }
};
/// cell_coordinate of grid.h.
HWY_INLINE Cells cell_coordinates(Pack coordinate, float inverse_edge, int cells) {
  const auto cell = hn::ConvertTo(Bits(), (coordinate * Pack(inverse_edge)).lanes);
  return {hn::Min(hn::Max(cell, hn::Zero(Bits())), hn::Set(Bits(), cells - 1))};
}
HWY_INLINE Cells select(Mask m, Cells yes, int no) {
  return {hn::IfThenElse(hn::RebindMask(Bits(), m.lanes), yes.lanes, hn::Set(Bits(), no))};
}
/// a * factor + b
HWY_INLINE Cells combine(Cells a, int factor, Cells b) {
  return {hn::Add(hn::Mul(a.lanes, hn::Set(Bits(), factor)), b.lanes)};
}

}  // namespace

}  // namespace squall::openmp
