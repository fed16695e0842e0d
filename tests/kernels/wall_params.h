#pragma once

#include <gtest/gtest.h>

#include "params.h"

namespace squall::test {

/// The constants that wall formulas read, with H = 1.
template <class Scalar>
Params<Scalar> unit_params() {
  Params<Scalar> params{};
  params.inverse_support = 1;
  params.thirtieth = static_cast<Scalar>(1.0 / 30);
  params.fifth = static_cast<Scalar>(1.0 / 5);
  params.two_hundred_fifty_sixth = static_cast<Scalar>(1.0 / 256);
  params.one_half = static_cast<Scalar>(0.5);
  return params;
}

/// The same for a container of this size with a lid, and a support radius [m].
template <class Scalar>
Params<Scalar> container_params(double x, double y, double z, double support) {
  Params<Scalar> params = unit_params<Scalar>();
  params.inverse_support = static_cast<Scalar>(1 / support);
  params.support_radius = static_cast<Scalar>(support);
  params.size_x = static_cast<Scalar>(x);
  params.size_y = static_cast<Scalar>(y);
  params.size_z = static_cast<Scalar>(z);
  params.lid = 1;
  params.clamp_distance = static_cast<Scalar>(0.005 * support);
  params.lost_distance = static_cast<Scalar>(10 * y);
  return params;
}

}  // namespace squall::test
