#pragma once

namespace squall::openmp {
namespace {
using Scalar = double;
}
}  // namespace squall::openmp

#include "backend_omp/highway_pack.h"

namespace squall::openmp {

namespace {  // each instruction set and precision has a Pack of its own

/// Writes first + lane for the lanes of `m` below `limit`, packed; scribbles over k_lanes entries. Returns how many.
HWY_INLINE int append_lanes(int* list, int first, Mask m, int limit) {
  const hn::Rebind<std::int32_t, Scalars> d;
  const hn::Rebind<std::uint8_t, Scalars> bytes;
  std::uint8_t bits = 0;
  hn::StoreMaskBits(Scalars(), m.lanes, &bits);
  if (limit < Pack::k_lanes) bits = static_cast<std::uint8_t>(bits & ((1u << limit) - 1u));
  const auto lanes = hn::PromoteTo(d, hn::LoadU(bytes, k_set_bits.numbers[bits]));
  hn::StoreU(hn::Add(lanes, hn::Set(d, first)), d, list);
  return __builtin_popcount(bits);
}

/// See highway_pack.h.
HWY_INLINE void transpose_blocks(const hn::Vec<Scalars>* from, hn::Vec<Scalars>* to) {
  to[0] = hn::InterleaveLower(Scalars(), from[0], from[1]);
  to[1] = hn::InterleaveUpper(Scalars(), from[0], from[1]);
}

/// Sum of convergence_term over the lanes of `valid`.
HWY_INLINE std::int64_t sum_of_terms(Pack error, Mask valid) {
  return hn::GetLane(hn::SumOfLanes(Bits(), rounded_terms(Scalars(), clamped_errors(error, valid))));
}

/// A cell coordinate per lane, an integer kept in a double.
struct Cells {
  hn::Vec<Scalars> lanes;
  HWY_INLINE void store(int* to) const {
    const hn::Rebind<std::int32_t, Scalars> d;
    hn::StoreU(hn::DemoteTo(d, lanes), d, to);
  }
};
/// cell_coordinate of grid.h.
HWY_INLINE Cells cell_coordinates(Pack coordinate, double inverse_edge, int cells) {
  const auto cell = hn::Trunc((coordinate * Pack(inverse_edge)).lanes);
  return {hn::Min(hn::Max(cell, hn::Zero(Scalars())), hn::Set(Scalars(), static_cast<double>(cells - 1)))};
}
HWY_INLINE Cells select(Mask m, Cells yes, int no) {
  return {hn::IfThenElse(m.lanes, yes.lanes, hn::Set(Scalars(), static_cast<double>(no)))};
}
/// a * factor + b
HWY_INLINE Cells combine(Cells a, int factor, Cells b) {
  return {hn::MulAdd(a.lanes, hn::Set(Scalars(), static_cast<double>(factor)), b.lanes)};
}

}  // namespace

}  // namespace squall::openmp
