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

/// Blocks of two doubles, 2 records of 8 doubles apart.
HWY_INLINE hn::Vec<Scalars> load_blocks(const double* from) {
  const hn::FixedTag<double, 2> block;
  const hn::FixedTag<double, 4> two;
  const auto low = hn::Combine(two, hn::LoadU(block, from + 16), hn::LoadU(block, from));
#if HWY_STATIC_TARGET <= HWY_AVX3
  return hn::Combine(Scalars(), hn::Combine(two, hn::LoadU(block, from + 48), hn::LoadU(block, from + 32)), low);
#else
  return low;
#endif
}
HWY_INLINE void store_blocks(hn::Vec<Scalars> blocks, double* to) {
  const hn::FixedTag<double, 2> block;
#if HWY_STATIC_TARGET <= HWY_AVX3
  const hn::FixedTag<double, 4> two;
  const auto high = hn::UpperHalf(two, blocks);
  hn::StoreU(hn::LowerHalf(block, high), block, to + 32);
  hn::StoreU(hn::UpperHalf(block, high), block, to + 48);
  const auto low = hn::LowerHalf(two, blocks);
#else
  const auto low = blocks;
#endif
  hn::StoreU(hn::LowerHalf(block, low), block, to);
  hn::StoreU(hn::UpperHalf(block, low), block, to + 16);
}

/// Half the fields of k_lanes records of 8 doubles: fields[f] has double `first` + f of every record, one lane each;
/// `first` is 0 or 4. Two fields at a time: even records' in one vector, odd ones' in another, interleaved.
HWY_INLINE void load_fields(const double* records, int first, Pack* fields) {
  const Scalars d;
  for (int f = 0; f < 4; f += 2) {
    const auto even = load_blocks(records + first + f), odd = load_blocks(records + 8 + first + f);
    fields[f] = Pack(hn::InterleaveLower(d, even, odd));
    fields[f + 1] = Pack(hn::InterleaveUpper(d, even, odd));
  }
}
HWY_INLINE void store_fields(double* records, int first, const Pack* fields) {
  const Scalars d;
  for (int f = 0; f < 4; f += 2) {
    store_blocks(hn::InterleaveLower(d, fields[f].lanes, fields[f + 1].lanes), records + first + f);
    store_blocks(hn::InterleaveUpper(d, fields[f].lanes, fields[f + 1].lanes), records + 8 + first + f);
  }
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
