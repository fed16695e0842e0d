// The share of a particle's support that a solid box fills: against quadrature, and its gradient against differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "kernels/wall_params.h"
#include "support/numbers.h"
#include "walls.h"

namespace squall::test {
namespace {

constexpr std::array<int, 4> k_shapes = {SQUALL_CUBIC, SQUALL_POLY6, SQUALL_SPIKY, SQUALL_BELL};

struct BoxAt {
  std::array<double, 3> low, high;
};

// W at H = 1, integrating to 1.
double kernel(int shape, double r2) {
  if (r2 >= 1) return 0;
  if (shape == SQUALL_POLY6) return 315 / (64 * k_pi) * poly6_value(1 - r2);
  if (shape == SQUALL_BELL) return 315 / (8192 * k_pi) * bell_value(1 - r2);
  const double r = std::sqrt(r2);
  if (shape == SQUALL_SPIKY) return 15 / k_pi * spiky_value(1 - r);
  return 8 / k_pi * cubic_value(1 - r, max0(1 - 2 * r));
}

// Midpoints of `n` cells of [low, high] cut to the support, and their width.
std::vector<double> midpoints(double low, double high, int n, double* width) {
  low = std::clamp(low, -1.0, 1.0);
  high = std::clamp(high, -1.0, 1.0);
  *width = (high - low) / n;
  std::vector<double> points;
  for (int i = 0; i < n; ++i) points.push_back(low + (i + 0.5) * *width);
  return points;
}

// Midpoint rule over the box with n^3 cells, the particle in the origin: an error of order 1/n^2, so that the
// difference to half as many cells per axis bounds it.
double quadrature(int shape, const BoxAt& box, int n) {
  std::array<double, 3> width;
  std::array<std::vector<double>, 3> points;
  for (std::size_t axis = 0; axis < 3; ++axis) points[axis] = midpoints(box.low[axis], box.high[axis], n, &width[axis]);
  double sum = 0;
  for (const double z : points[2])
    for (const double y : points[1])
      for (const double x : points[0]) sum += kernel(shape, x * x + y * y + z * z);
  return sum * width[0] * width[1] * width[2];
}

double share(int shape, const BoxAt& box, const std::array<double, 3>& at = {0, 0, 0},
             std::array<double, 3>* gradient = nullptr, double support = 1) {
  Params<double> params = unit_params<double>();
  params.inverse_support = 1 / support;
  std::array<double, 3> g = {0, 0, 0};
  const double open =
      close_box(&params, shape, box.low.data(), box.high.data(), at[0], at[1], at[2], 1.0, &g[0], &g[1], &g[2]);
  if (gradient) *gradient = g;
  return 1 - open;
}

bool contains_origin(const BoxAt& box) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.low[axis] >= 0 || box.high[axis] <= 0) return false;
  return true;
}

BoxAt random_box(std::mt19937& random, bool thin) {
  std::uniform_real_distribution<double> place(-1.2, 1.2), thickness(0.02, 0.3);
  BoxAt box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double a = place(random), b = place(random);
    box.low[axis] = std::min(a, b);
    box.high[axis] = std::max(a, b);
  }
  if (thin) box.high[0] = box.low[0] + thickness(random);
  return box;
}

// The product over the axes is exact for separable kernels only. Where two walls meet at an edge the error is largest
// with the particle 0.3 H from both: 0.00163 (cubic), 0.0032 (poly6), 0.00083 (spiky), 0.00166 (bell), found by
// quadrature (docs/physics.md).
constexpr std::array<double, 4> k_edge_error = {0.00163, 0.0032, 0.00083, 0.00166};

TEST(BoxShare, IsWithinItsClaimOfQuadratureAtAnEdge) {
  for (const int shape : k_shapes) {
    for (int i = 0; i <= 10; ++i)
      for (int j = 0; j <= i; ++j) {
        const BoxAt box = {{i / 10.0, j / 10.0, -1}, {2, 2, 1}};
        const double exact = quadrature(shape, box, 40);
        const double quadrature_error = std::abs(exact - quadrature(shape, box, 20));
        EXPECT_NEAR(share(shape, box), exact, k_edge_error[static_cast<std::size_t>(shape)] + quadrature_error)
            << "shape " << shape << ", corner at " << i / 10.0 << ", " << j / 10.0;
      }
  }
}

// A box that is infinite along one axis is four such edges, added with alternating signs: four times the error bounds
// it. Boxes that end on every axis are held to the same.
TEST(BoxShare, IsWithinItsClaimOfQuadratureForRandomBoxes) {
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    BoxAt box = random_box(random, i % 2 == 1);
    while (contains_origin(box)) box = random_box(random, i % 2 == 1);
    for (const int shape : k_shapes) {
      const double exact = quadrature(shape, box, 40);
      const double quadrature_error = std::abs(exact - quadrature(shape, box, 20));
      EXPECT_NEAR(share(shape, box), exact, 4 * k_edge_error[static_cast<std::size_t>(shape)] + quadrature_error)
          << "box " << i << ", shape " << shape;
      ASSERT_LT(quadrature_error, 0.001) << "the quadrature decides nothing";
    }
  }
}

TEST(BoxShare, OfAHalfSpaceIsTheWallShare) {
  const Params<double> params = unit_params<double>();
  for (const int shape : k_shapes)
    for (const double distance : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const BoxAt box = {{distance, -2, -2}, {5, 2, 2}};
      EXPECT_NEAR(share(shape, box), wall_share(&params, shape, distance), rounding<double>(16)) << distance;
    }
}

TEST(BoxShare, GrowsWithTheBoxAndNeverPassesOne) {
  for (const int shape : k_shapes) {
    double before = -rounding<double>(16);
    for (int i = 0; i <= 60; ++i) {
      const double half = i * 0.02;
      const double now = share(shape, {{-half, -half, -half}, {half, half, half}});
      EXPECT_GE(now, before - rounding<double>(16)) << half;
      EXPECT_LE(now, 1 + rounding<double>(16)) << half;
      before = now;
    }
    EXPECT_NEAR(before, 1, rounding<double>(16)) << "a particle deep inside sees nothing else";
  }
}

TEST(BoxShare, BeyondTheSupportItIsExactlyNothing) {
  for (const int shape : k_shapes)
    for (const BoxAt& box : {BoxAt{{1.001, -1, -1}, {2, 1, 1}}, BoxAt{{-1, -3, -1}, {1, -1.0, 1}}}) {
      std::array<double, 3> gradient;
      EXPECT_EQ(share(shape, box, {0, 0, 0}, &gradient), 0.0);
      for (const double slope : gradient) EXPECT_EQ(slope, 0.0);
    }
}

// Gradient of the open share, at a support radius that is not one. Central differences: h^2/6 times third derivatives
// below 60/H^3, plus rounding over h.
TEST(BoxShare, GradientIsTheDerivative) {
  std::mt19937 random(12);
  const double support = 0.5, step = 1e-5 * support;
  const double tolerance = 1e-10 / 6 * 60 / support + rounding<double>(60, 1) / step;
  for (int i = 0; i < 100; ++i) {
    const BoxAt box = random_box(random, i % 2 == 1);
    for (const int shape : k_shapes) {
      const std::array<double, 3> at = {0.11, -0.07, 0.02};
      std::array<double, 3> gradient;
      share(shape, box, at, &gradient, support);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<double, 3> ahead = at, behind = at;
        ahead[axis] += step;
        behind[axis] -= step;
        const double slope =
            -(share(shape, box, ahead, nullptr, support) - share(shape, box, behind, nullptr, support)) / (2 * step);
        EXPECT_NEAR(gradient[axis], slope, tolerance) << "box " << i << ", shape " << shape << ", axis " << axis;
      }
    }
  }
}

TEST(ContainerOpening, GradientIsTheDerivative) {
  const double support = 0.5, step = 1e-5 * support;
  const double tolerance = 1e-10 / 6 * 60 / support + rounding<double>(60, 1) / step;
  const auto params = container_params<double>(0.9, 0.7, 0.55, support);
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(0.05, 0.5);
  for (int i = 0; i < 200; ++i) {
    const std::array<double, 3> at = {unit(random), unit(random), unit(random)};
    for (const int shape : k_shapes) {
      auto open = [&](double x, double y, double z) {
        std::array<double, 3> g;
        return container_opening(&params, shape, 0.04, x, y, z, &g[0], &g[1], &g[2]);
      };
      std::array<double, 3> gradient;
      container_opening(&params, shape, 0.04, at[0], at[1], at[2], &gradient[0], &gradient[1], &gradient[2]);
      auto slope = [&](double x, double y, double z) {
        return (open(at[0] + x, at[1] + y, at[2] + z) - open(at[0] - x, at[1] - y, at[2] - z)) / (2 * step);
      };
      EXPECT_NEAR(gradient[0], slope(step, 0, 0), tolerance);
      EXPECT_NEAR(gradient[1], slope(0, step, 0), tolerance);
      EXPECT_NEAR(gradient[2], slope(0, 0, step), tolerance);
    }
  }
}

// Container and box together: open shares multiply, also in the gradient.
TEST(BoxShare, MultipliesWithWhatWasOpenBefore) {
  const Params<double> params = unit_params<double>();
  const BoxAt box = {{0.2, -0.3, -2}, {0.6, 0.4, 2}};
  const double open = 0.75;
  std::array<double, 3> alone, both = {0.3, -0.2, 0.1};
  const double left = 1 - share(SQUALL_CUBIC, box, {0, 0, 0}, &alone);
  const double result = close_box(&params, SQUALL_CUBIC, box.low.data(), box.high.data(), 0.0, 0.0, 0.0, open, &both[0],
                                  &both[1], &both[2]);
  EXPECT_NEAR(result, open * left, rounding<double>(4));
  EXPECT_NEAR(both[0], 0.3 * left + open * alone[0], rounding<double>(8));
  EXPECT_NEAR(both[1], -0.2 * left + open * alone[1], rounding<double>(8));
  EXPECT_NEAR(both[2], 0.1 * left + open * alone[2], rounding<double>(8));
}

// Single precision: a box share is a product of three differences of values near 1.
TEST(BoxShare, SinglePrecisionFollowsDouble) {
  std::mt19937 random(14);
  for (int i = 0; i < 200; ++i) {
    const BoxAt box = random_box(random, i % 2 == 1);
    std::array<float, 3> low, high;
    BoxAt rounded;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = static_cast<float>(box.low[axis]);
      high[axis] = static_cast<float>(box.high[axis]);
      rounded.low[axis] = low[axis];
      rounded.high[axis] = high[axis];
    }
    const auto params = unit_params<float>();
    for (const int shape : k_shapes) {
      std::array<float, 3> g = {0, 0, 0};
      const float open =
          close_box(&params, shape, low.data(), high.data(), 0.0f, 0.0f, 0.0f, 1.0f, &g[0], &g[1], &g[2]);
      std::array<double, 3> gradient;
      EXPECT_NEAR(open, 1 - share(shape, rounded, {0, 0, 0}, &gradient), rounding<float>(3 * 2 * 12, 7));
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(g[axis], gradient[axis], rounding<float>(3 * 2 * 12, 1.5 * 7));
    }
  }
}

}  // namespace
}  // namespace squall::test
