#pragma once

#include <cmath>
#include <limits>

namespace squall::test {

inline constexpr double k_pi = 3.141592653589793238462643383279502884;

/// Error bound of a chain of `roundings` operations in Real on values up to `scale`.
template <class Real>
double rounding(double roundings, double scale = 1.0) {
  return roundings * std::numeric_limits<Real>::epsilon() * std::abs(scale);
}

/// Half a unit in the last of `digits` decimals: what a printed reference value leaves open.
inline double printed(int digits) { return 0.5 * std::pow(10.0, -digits); }

}  // namespace squall::test
