#pragma once

#include "shared.h"

namespace squall::openmp {

namespace {  // each instruction set has a Pack of its own

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
  float lane;

  Pack() = default;
  explicit Pack(float value) : lane(value) {}
  static Pack load(const float* from) { return Pack(*from); }
  void store(float* to) const { *to = lane; }

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

}  // namespace

}  // namespace squall::openmp
