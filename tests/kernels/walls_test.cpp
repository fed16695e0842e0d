// Wall shares in closed form: tables computed elsewhere, derivatives, the product rule at edges and corners, thin gaps.
#include "walls.h"

#include <gtest/gtest.h>

#include <array>

#include "kernels/wall_params.h"
#include "support/numbers.h"

namespace squall::test {
namespace {

template <class Real>
class Walls : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Walls, Reals);

constexpr std::array<int, 4> k_shapes = {SQUALL_CUBIC, SQUALL_POLY6, SQUALL_SPIKY, SQUALL_BELL};

// A share is a polynomial of degree 11 at most in u <= 1; its Horner chain passes intermediates below 1700 u^5/256, the
// cubic's below 48 u^5/30: 12 roundings of at most this size. What bell takes off poly6's is below 0.05.
constexpr double k_share_roundings = 12, k_share_scale = 7;

TYPED_TEST(Walls, SharesMatchTheTable) {
  using Real = TypeParam;
  const auto params = unit_params<Real>();
  const std::array<std::array<double, 11>, 4> table = {{
      {.5, .362622, .240002, .142669, .074622, .033333, .012015, .003110, .000444, .000015, 0},
      {.5, .378579, .266568, .171719, .098809, .048927, .019581, .005629, .000891, .000033, 0},
      {.5, .354294, .229376, .134456, .069984, .031250, .011264, .002916, .000416, .000014, 0},
      {.5, .362538, .239835, .142475, .074411, .033114, .011911, .003119, .000462, .000017, 0},
  }};
  for (const int shape : k_shapes)
    for (int i = 0; i <= 10; ++i)
      EXPECT_NEAR(wall_share(&params, shape, static_cast<Real>(i / 10.0)),
                  table[static_cast<std::size_t>(shape)][static_cast<std::size_t>(i)],
                  printed(6) + rounding<Real>(k_share_roundings, k_share_scale))
          << "shape " << shape << ", q = " << i / 10.0;
}

TYPED_TEST(Walls, CubicMarginalMatchesTheTable) {
  using Real = TypeParam;
  const auto params = unit_params<Real>();
  const std::array<double, 11> table = {1.4,     1.322208, 1.112256, .827744, .537792, .300000,
                                        .139264, .049248,  .010752,  .000736, 0};
  for (int i = 0; i <= 10; ++i)
    EXPECT_NEAR(wall_marginal(&params, SQUALL_CUBIC, static_cast<Real>(i / 10.0)), table[static_cast<std::size_t>(i)],
                printed(6) + rounding<Real>(8, 10))
        << i;
}

// The integrals as derived, in powers of q; the formulas are in powers of u.
TEST(WallClosedForms, AgreeWithTheIntegralsInPowersOfQ) {
  const auto params = unit_params<double>();
  for (int i = 0; i <= 1000; ++i) {
    const double q = i / 1000.0, u = 1 - q, q2 = q * q;
    SCOPED_TRACE(q);
    const double cubic =
        q < .5 ? .5 - (7 * q / 5 - 8 * std::pow(q, 3) / 3 + 24 * std::pow(q, 5) / 5 - 3.2 * std::pow(q, 6))
               : 1.6 * std::pow(u, 5) - 16. / 15 * std::pow(u, 6);
    const double cubic_slope =
        q < .5 ? 1.4 - 8 * q2 + 24 * q2 * q2 - 19.2 * std::pow(q, 5) : 1.6 * std::pow(u, 4) * (1 + 4 * q);
    const double poly6 =
        .5 - 315. / 256 *
                 (q - 4 * std::pow(q, 3) / 3 + 6 * std::pow(q, 5) / 5 - 4 * std::pow(q, 7) / 7 + std::pow(q, 9) / 9);
    const double bell_slope = .5 * (315. / 256 * std::pow(1 - q2, 4) + 6435. / 4096 * std::pow(1 - q2, 7));
    const double tolerance = rounding<double>(k_share_roundings, k_share_scale);
    EXPECT_NEAR(wall_share(&params, SQUALL_CUBIC, q), cubic, tolerance);
    EXPECT_NEAR(wall_share(&params, SQUALL_POLY6, q), poly6, tolerance);
    EXPECT_NEAR(wall_share(&params, SQUALL_SPIKY, q), 1.5 * std::pow(u, 5) - std::pow(u, 6), tolerance);
    EXPECT_NEAR(wall_marginal(&params, SQUALL_CUBIC, q), cubic_slope, 4 * tolerance);
    EXPECT_NEAR(wall_marginal(&params, SQUALL_POLY6, q), 315. / 256 * std::pow(1 - q2, 4), 4 * tolerance);
    EXPECT_NEAR(wall_marginal(&params, SQUALL_SPIKY, q), 1.5 * std::pow(u, 4) * (1 + 4 * q), 4 * tolerance);
    EXPECT_NEAR(wall_marginal(&params, SQUALL_BELL, q), bell_slope, 4 * tolerance);
  }
}

// Central differences; |lambda'''| <= 20 for each kernel.
TEST(WallClosedForms, MarginalIsTheDerivativeOfTheShare) {
  const auto params = unit_params<double>();
  const double step = 1e-5,
               tolerance = step * step / 6 * 20 + rounding<double>(k_share_roundings, k_share_scale) / step;
  for (const int shape : k_shapes)
    for (int i = 1; i < 110; ++i) {
      const double q = i / 100.0 + 0.001;
      const double slope = (wall_share(&params, shape, q + step) - wall_share(&params, shape, q - step)) / (2 * step);
      EXPECT_NEAR(slope, -wall_marginal(&params, shape, q), tolerance) << "shape " << shape << ", q = " << q;
    }
}

// On the plane, behind it and beyond the support: finite, and exact where nothing may be left over.
TYPED_TEST(Walls, AreExactAtTheEnds) {
  using Real = TypeParam;
  const auto params = unit_params<Real>();
  for (const int shape : k_shapes) {
    EXPECT_NEAR(wall_share(&params, shape, Real(0)), 0.5, rounding<Real>(2, 0.5)) << shape;
    for (const Real q : {Real(1), Real(1.25), Real(1e6)}) {
      EXPECT_EQ(wall_share(&params, shape, q), Real(0)) << shape;
      EXPECT_EQ(wall_marginal(&params, shape, q), Real(0)) << shape;
    }
  }
}

TYPED_TEST(Walls, MiddleOfABigContainerIsExactlyOpen) {
  using Real = TypeParam;
  const auto params = container_params<Real>(3, 3, 3, 0.25);
  for (const int shape : k_shapes) {
    Real gx, gy, gz;
    EXPECT_EQ(container_opening(&params, shape, Real(0), Real(1.5), Real(1.5), Real(1.5), &gx, &gy, &gz), Real(1));
    EXPECT_EQ(gx, Real(0));
    EXPECT_EQ(gy, Real(0));
    EXPECT_EQ(gz, Real(0));
  }
}

TYPED_TEST(Walls, CornersMultiplyAndGradientsPointInside) {
  using Real = TypeParam;
  const auto params = container_params<Real>(3, 3, 3, 1);
  for (const int shape : k_shapes) {
    for (const Real d : {Real(0), Real(1e-7), Real(0.2), Real(0.4)}) {
      SCOPED_TRACE(testing::Message() << "shape " << shape << ", distance " << d);
      const double open = 1 - static_cast<double>(wall_share(&params, shape, d));
      Real gx, gy, gz;
      const double tolerance = rounding<Real>(8);
      EXPECT_NEAR(container_opening(&params, shape, Real(0), d, d, d, &gx, &gy, &gz), open * open * open, tolerance);
      EXPECT_GT(gx, Real(0));
      EXPECT_EQ(gx, gy);
      EXPECT_EQ(gy, gz);
      // behind the planes the share stays what it is on them
      EXPECT_NEAR(container_opening(&params, shape, Real(0), -d, -d, -d, &gx, &gy, &gz), 0.125, tolerance);
      EXPECT_NEAR(container_opening(&params, shape, Real(0), Real(3) - d, d, Real(1.5), &gx, &gy, &gz), open * open,
                  tolerance);
      EXPECT_LT(gx, Real(0));
    }
  }
}

TYPED_TEST(Walls, AnOpenTopHasNoWall) {
  using Real = TypeParam;
  auto params = container_params<Real>(3, 3, 3, 1);
  params.lid = 0;
  Real gx, gy, gz;
  EXPECT_EQ(container_opening(&params, SQUALL_CUBIC, Real(0), Real(1.5), Real(2.9), Real(1.5), &gx, &gy, &gz), Real(1));
  EXPECT_EQ(gy, Real(0));
}

// However thin the gap between two walls, they fill less than all of the support (hard case: gaps of dx and dx/2).
TYPED_TEST(Walls, ThinGapsNeverFillUp) {
  using Real = TypeParam;
  const double support = 2;
  for (const double gap : {1.0, 0.5, 0.01, 1e-6}) {
    const auto params = container_params<Real>(gap, gap, gap, support);
    for (const int shape : k_shapes)
      for (const double at : {0.0, 0.25, 0.5, 1.0}) {
        SCOPED_TRACE(testing::Message() << "gap " << gap << ", shape " << shape << ", at " << at);
        const Real x = static_cast<Real>(gap * at);
        Real gx, gy, gz;
        const Real open = container_opening(&params, shape, Real(0), x, x, x, &gx, &gy, &gz);
        EXPECT_GT(open, Real(0.01)) << "(1/2)^6 at the least";
        EXPECT_LT(open, Real(1));
        EXPECT_TRUE(std::isfinite(gx) && std::isfinite(gy) && std::isfinite(gz));
        EXPECT_LE(std::abs(gx), 1.5 / support);
      }
  }
}

TYPED_TEST(Walls, ShiftMovesThePlanesOutward) {
  using Real = TypeParam;
  const auto params = container_params<Real>(3, 3, 3, 1);
  const Real shift = Real(0.125);
  for (const int shape : k_shapes) {
    Real gx, gy, gz;
    const Real open = container_opening(&params, shape, shift, Real(0.25), Real(1.5), Real(1.5), &gx, &gy, &gz);
    EXPECT_NEAR(open, 1 - static_cast<double>(wall_share(&params, shape, Real(0.375))), rounding<Real>(4));
  }
}

}  // namespace
}  // namespace squall::test
