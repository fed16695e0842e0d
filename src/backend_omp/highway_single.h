#pragma once

namespace squall::openmp {
namespace {
using Scalar = float;
}
}  // namespace squall::openmp

#include "backend_omp/highway_pack.h"

namespace squall::openmp {

namespace {  // each instruction set and precision has a Pack of its own

/// Writes first + lane for the lanes of `m` below `limit`, packed; scribbles over k_lanes entries. Returns how many.
HWY_INLINE int append_lanes(int* list, int first, Mask m, int limit) {
  const Bits d;
#if HWY_STATIC_TARGET > HWY_AVX3
  std::uint8_t bits = 0;
  hn::StoreMaskBits(Scalars(), m.lanes, &bits);
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
HWY_INLINE void transpose_blocks(const hn::Vec<Scalars>* from, hn::Vec<Scalars>* to) {
  const Scalars d;
  const hn::RepartitionToWide<Scalars> wide;
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
HWY_INLINE hn::Vec<Scalars> load_blocks(const float* from) {
  const hn::FixedTag<float, 4> block;
  const hn::FixedTag<float, 8> two;
  const auto low = hn::Combine(two, hn::LoadU(block, from + 32), hn::LoadU(block, from));
#if HWY_STATIC_TARGET <= HWY_AVX3
  return hn::Combine(Scalars(), hn::Combine(two, hn::LoadU(block, from + 96), hn::LoadU(block, from + 64)), low);
#else
  return low;
#endif
}
HWY_INLINE void store_blocks(hn::Vec<Scalars> blocks, float* to) {
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
  hn::Vec<Scalars> blocks[4], columns[4];
  for (int i = 0; i < 4; ++i) blocks[i] = load_blocks(records + 8 * i + first);
  transpose_blocks(blocks, columns);
  for (int f = 0; f < 4; ++f) fields[f] = Pack(columns[f]);
}
HWY_INLINE void store_fields(float* records, int first, const Pack* fields) {
  hn::Vec<Scalars> blocks[4], columns[4];
  for (int f = 0; f < 4; ++f) columns[f] = fields[f].lanes;
  transpose_blocks(columns, blocks);
  for (int i = 0; i < 4; ++i) store_blocks(blocks[i], records + 8 * i + first);
}

/// Sum of convergence_term over the lanes of `valid`.
HWY_INLINE std::int64_t sum_of_terms(Pack error, Mask valid) {
  const hn::RepartitionToWide<Scalars> wide;
  const hn::Half<Scalars> half;
  const auto clamped = clamped_errors(error, valid);
  const auto rounded = [&](auto half_lanes) { return rounded_terms(wide, hn::PromoteTo(wide, half_lanes)); };
  const auto sums = hn::Add(rounded(hn::LowerHalf(half, clamped)), rounded(hn::UpperHalf(half, clamped)));
  return hn::GetLane(hn::SumOfLanes(hn::RebindToSigned<decltype(wide)>(), sums));
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
