// Cores of walls: what they take of the open share, and that gradients are those of the share, by finite differences.
#include "wall_cores.h"

#include <gtest/gtest.h>

#include "kernels/wall_params.h"
#include "support/numbers.h"
#include "walls.h"

namespace squall::test {
namespace {

constexpr double k_share = 0.05, k_reach = 0.05;

Params<double> params_with_cores() {
  Params<double> params = container_params<double>(0.8, 0.6, 0.4, 0.2);
  params.core_share = k_share;
  params.inverse_core_reach = 1 / k_reach;
  params.tiny = 1e-20;
  return params;
}

Box<double> box_in_the_middle() {
  Box<double> box{};
  const double low[3] = {0.3, 0.2, 0.15}, high[3] = {0.5, 0.35, 0.25};
  for (int axis = 0; axis < 3; ++axis) {
    box.solid_min[axis] = box.density_min[axis] = box.force_min[axis] = low[axis];
    box.solid_max[axis] = box.density_max[axis] = box.force_max[axis] = high[axis];
  }
  return box;
}

struct Share {
  double open = 0, gradient[3] = {};
};

/// Walls and cores of the container and one box, as dfsph composes them.
Share share_at(const double* x) {
  const auto params = params_with_cores();
  const auto box = box_in_the_middle();
  Share s;
  double* g = s.gradient;
  s.open = container_opening(&params, SQUALL_BELL, 0.004, x[0], x[1], x[2], g, g + 1, g + 2);
  s.open = close_box(&params, SQUALL_BELL, box.density_min, box.density_max, x[0], x[1], x[2], s.open, g, g + 1, g + 2);
  s.open = close_container_cores(&params, x[0], x[1], x[2], s.open, g, g + 1, g + 2);
  s.open = close_box_core(&params, &box, x[0], x[1], x[2], s.open, g, g + 1, g + 2);
  return s;
}

TEST(WallCores, TakeTheirShareAtAFaceAndNothingFromTheirReachOn) {
  const auto params = params_with_cores();
  const auto open_at = [&](double x) {
    double g[3] = {};
    return close_container_cores(&params, x, 0.3, 0.2, 1.0, g, g + 1, g + 2);
  };
  EXPECT_DOUBLE_EQ(open_at(0), 1 - k_share);
  EXPECT_DOUBLE_EQ(open_at(0.8), 1 - k_share);
  EXPECT_DOUBLE_EQ(open_at(-0.01), 1 - k_share) << "behind the face";
  EXPECT_DOUBLE_EQ(open_at(0.5 * k_reach), 1 - k_share / 4);
  EXPECT_EQ(open_at(k_reach), 1);
  EXPECT_EQ(open_at(0.4), 1);
  double g[3] = {1, 2, 3};
  EXPECT_EQ(close_container_cores(&params, 0.4, 0.3, 0.2, 0.75, g, g + 1, g + 2), 0.75);
  EXPECT_EQ(g[0], 1);
  EXPECT_EQ(g[1], 2);
  EXPECT_EQ(g[2], 3);
}

TEST(WallCores, OfABoxSurroundIt) {
  const auto params = params_with_cores();
  const auto box = box_in_the_middle();
  const auto open_at = [&](double x, double y, double z) {
    double g[3] = {};
    return close_box_core(&params, &box, x, y, z, 1.0, g, g + 1, g + 2);
  };
  EXPECT_DOUBLE_EQ(open_at(0.3, 0.3, 0.2), 1 - k_share) << "on a face";
  EXPECT_DOUBLE_EQ(open_at(0.3 - k_reach / 2, 0.3, 0.2), 1 - k_share / 4);
  EXPECT_DOUBLE_EQ(open_at(0.3 - k_reach / 2, 0.35 + k_reach / 2, 0.2), 1 - k_share / 16) << "off an edge";
  EXPECT_EQ(open_at(0.3 - k_reach, 0.3, 0.2), 1);
}

// A core is quadratic along an axis: a central difference over 2 h is off by no more than third derivatives of the wall
// integral, below 200/H^3, times h^2/6, and by eps/h; at the core's end, where the second derivative jumps by
// 2 core_share/reach^2, by that times h.
TEST(WallCores, GradientsAreThoseOfTheShare) {
  constexpr double h = 1e-6;
  const double tolerance = 200 / std::pow(0.2, 3) * h * h / 6 + 8 * std::numeric_limits<double>::epsilon() / h +
                           2 * k_share / (k_reach * k_reach) * h;
  int felt = 0;
  for (double x = 0.005; x < 0.8; x += 0.0371)
    for (double y = 0.005; y < 0.6; y += 0.0413)
      for (double z = 0.005; z < 0.4; z += 0.0291) {
        const double at[3] = {x, y, z};
        const Share here = share_at(at);
        for (int axis = 0; axis < 3; ++axis) {
          double before[3] = {x, y, z}, after[3] = {x, y, z};
          before[axis] -= h;
          after[axis] += h;
          const double difference = (share_at(after).open - share_at(before).open) / (2 * h);
          ASSERT_NEAR(here.gradient[axis], difference, tolerance) << x << " " << y << " " << z << " axis " << axis;
          felt += std::abs(difference) > 10 * tolerance;
        }
      }
  EXPECT_GT(felt, 1000) << "hardly any of these places are near a wall";
}

}  // namespace
}  // namespace squall::test
