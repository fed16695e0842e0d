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

/// See highway_pack.h.
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
