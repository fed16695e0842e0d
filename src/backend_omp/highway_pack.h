#pragma once

#include <hwy/highway.h>

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

}  // namespace

}  // namespace squall::openmp
