#pragma once

#include "core/convergence.h"
#include "grid.h"
#include "shared.h"

// Included by scalar_single.h and scalar_double.h, which say what Scalar is.

namespace squall::openmp {

namespace {  // each instruction set and precision has a Pack of its own

/// One lane: what a machine without AVX2 runs. Fused multiply-adds are std::fma, so the bits are those of the others.
struct Mask {
  bool lane;
  friend Mask operator&(Mask a, Mask b) { return {a.lane && b.lane}; }
  friend Mask operator|(Mask a, Mask b) { return {a.lane || b.lane}; }
};
inline bool any(Mask m) { return m.lane; }
/// Whether `m` holds in every lane of `valid`.
inline bool all(Mask m, Mask valid) { return m.lane || !valid.lane; }

struct Pack {
  static constexpr int k_lanes = 1;
  static constexpr bool k_many_registers = false;
  Scalar lane;

  Pack() = default;
  explicit Pack(Scalar value) : lane(value) {}
  static Pack load(const Scalar* from) { return Pack(*from); }
  void store(Scalar* to) const { *to = lane; }

  friend Pack operator+(Pack a, Pack b) { return Pack(a.lane + b.lane); }
  friend Pack operator-(Pack a, Pack b) { return Pack(a.lane - b.lane); }
  friend Pack operator*(Pack a, Pack b) { return Pack(a.lane * b.lane); }
  friend Pack operator/(Pack a, Pack b) { return Pack(a.lane / b.lane); }
  friend Pack operator-(Pack a) { return Pack(-a.lane); }
  friend Mask operator<(Pack a, Pack b) { return {a.lane < b.lane}; }
  friend Pack fma(Pack a, Pack b, Pack c) { return Pack(squall::fma(a.lane, b.lane, c.lane)); }
  friend Pack nfma(Pack a, Pack b, Pack c) { return Pack(squall::nfma(a.lane, b.lane, c.lane)); }
  friend Pack fms(Pack a, Pack b, Pack c) { return Pack(squall::fms(a.lane, b.lane, c.lane)); }
  friend Pack sqrt(Pack a) { return Pack(squall::sqrt(a.lane)); }
  friend Pack max0(Pack a) { return Pack(squall::max0(a.lane)); }
};
inline Pack smaller(Pack a, Pack b) { return a.lane < b.lane ? a : b; }
inline Pack larger(Pack a, Pack b) { return a.lane < b.lane ? b : a; }
inline Mask first_lanes(int count) { return {count > 0}; }
inline Pack select(Mask m, Pack yes, Pack no) { return m.lane ? yes : no; }
inline Scalar first_lane(Pack a) { return a.lane; }
inline Pack smallest_lane(Pack a) { return a; }
inline Pack largest_lane(Pack a) { return a; }

inline int append_lanes(int* list, int first, Mask m, int limit) {
  *list = first;
  return m.lane && limit > 0 ? 1 : 0;
}

inline void load_fields(const Scalar* records, int first, Pack* fields) {
  for (int f = 0; f < 4; ++f) fields[f] = Pack(records[first + f]);
}
inline void store_fields(Scalar* records, int first, const Pack* fields) {
  for (int f = 0; f < 4; ++f) records[first + f] = fields[f].lane;
}

/// Of the lane, unless it is not valid.
inline std::int64_t sum_of_terms(Pack error, Mask valid) { return valid.lane ? convergence_term(error.lane) : 0; }

struct Cells {
  int lane;
  void store(int* to) const { *to = lane; }
};
/// Of the lost any will do: no int says where they are.
inline Cells cell_coordinates(Pack coordinate, Scalar inverse_edge, int cells) {
  if (is_lost(coordinate.lane)) return {0};
  return {cell_coordinate(coordinate.lane, inverse_edge, cells)};
}
inline Cells select(Mask m, Cells yes, int no) { return {m.lane ? yes.lane : no}; }
inline Cells combine(Cells a, int factor, Cells b) { return {a.lane * factor + b.lane}; }

}  // namespace

}  // namespace squall::openmp
