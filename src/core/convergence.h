#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

/// When dfsph stops iterating, and how far an iteration reaches: decided alike on every backend, whatever the order in
/// which particles add up.
namespace squall {

/// What a particle's error (a relative density) adds to the sum that decides: 2^32 times itself, clamped to [0, 1024],
/// rounded to even. Not a number counts as 0. Sums of these are exact in any order (docs/determinism.md).
template <class Real>
std::int64_t convergence_term(Real error) {
  constexpr Real k_largest = 1024;
  const Real clamped = error > 0 ? (error < k_largest ? error : k_largest) : Real(0);
  return std::llrint(clamped * Real(4294967296));
}

/// The largest sum over `count` particles whose mean error is within `tolerance` (at most 0.5).
inline std::int64_t convergence_limit(double tolerance, std::int64_t count) {
  return std::llrint(std::ldexp(tolerance, 32)) * count;
}

/// How much of each particle's over-density goes away in a sub-step: all of it, unless the mean is beyond what the
/// sub-step may correct. `excess` is the sum of terms of density - 1 over `count` particles, `correction` that of
/// Substep.
template <class Real>
Real correction_share(std::int64_t excess, Real correction, std::int64_t count) {
  const std::int64_t allowed = convergence_term(correction) * count;
  return excess <= allowed ? Real(1) : static_cast<Real>(allowed) / static_cast<Real>(excess);
}

/// How far iterations extrapolate: t/(t + 3) for the t-th since the start or since the error last grew (Nesterov 1983
/// with the restart of O'Donoghue & Candes 2015, one iteration late so that a pass over particles can use it at once).
class Momentum {
 public:
  template <class Real>
  Real next() {
    if (last_ > before_) age_ = 0;
    const Real reach = static_cast<Real>(age_) / static_cast<Real>(age_ + 3);
    ++age_;
    return reach;
  }

  /// The sum of errors that the iteration found.
  void found(std::int64_t sum) {
    before_ = last_;
    last_ = sum;
  }

 private:
  int age_ = 0;
  std::int64_t last_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t before_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace squall
