// Cells: clamping, order, and the claim everything rests on: two particles within H are never further apart than one
// cell in y and z and k_x_fineness cells in x, whatever rounding does.
#include "grid.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "support/numbers.h"

namespace squall::test {
namespace {

template <class Real>
class Grid : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Grid, Reals);

template <class Scalar>
Params<Scalar> grid_params(double support, int cells_x, int cells_y, int cells_z) {
  Params<Scalar> params{};
  const double edge = support * (1 + 1e-5);
  params.inverse_edge_yz = static_cast<Scalar>(1 / edge);
  params.inverse_edge_x = static_cast<Scalar>(k_x_fineness / edge);
  params.cells_x = cells_x;
  params.cells_y = cells_y;
  params.cells_z = cells_z;
  params.cell_count = cells_x * cells_y * cells_z;
  return params;
}

TYPED_TEST(Grid, CoordinatesOutsideFallIntoTheOutermostCells) {
  using Real = TypeParam;
  const Real inverse = Real(2);
  EXPECT_EQ(cell_coordinate(Real(0), inverse, 8), 0);
  EXPECT_EQ(cell_coordinate(Real(0.5), inverse, 8), 1);
  EXPECT_EQ(cell_coordinate(std::nextafter(Real(0.5), Real(0)), inverse, 8), 0);
  EXPECT_EQ(cell_coordinate(Real(3.75), inverse, 8), 7);
  for (const Real outside : {Real(-0.0), Real(-1e-7), Real(-0.4), Real(-0.5), Real(-0.6), Real(-1000)})
    EXPECT_EQ(cell_coordinate(outside, inverse, 8), 0) << outside;
  for (const Real outside : {Real(4), Real(4.1), Real(1000)})
    EXPECT_EQ(cell_coordinate(outside, inverse, 8), 7) << outside;
  EXPECT_EQ(cell_coordinate(Real(17), inverse, 1), 0);
}

TYPED_TEST(Grid, CellsRunAlongXFirst) {
  using Real = TypeParam;
  const auto params = grid_params<Real>(1.0, 6, 4, 5);
  int expected = 0;
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 6; ++x) {
        const Real edge = Real(1 + 1e-5);
        EXPECT_EQ(cell_of(&params, (Real(x) + Real(0.5)) * edge / k_x_fineness, (Real(y) + Real(0.5)) * edge,
                          (Real(z) + Real(0.5)) * edge),
                  expected++);
      }
  EXPECT_EQ(cell_of(&params, Real(-3), Real(-3), Real(-3)), 0);
  EXPECT_EQ(cell_of(&params, Real(99), Real(99), Real(99)), params.cell_count - 1);
  EXPECT_EQ(held_cell(&params), params.cell_count);
  EXPECT_EQ(lost_cell(&params), params.cell_count + 1);
}

TYPED_TEST(Grid, LostParticlesAreKnownByTheirPlace) {
  using Real = TypeParam;
  EXPECT_TRUE(is_lost(static_cast<Real>(SQUALL_LOST_COORDINATE)));
  for (const Real x : {Real(0), Real(-1e30), Real(1e28)}) EXPECT_FALSE(is_lost(x)) << x;
}

// The largest coordinate within `support` of x, as Scalar.
template <class Scalar>
Scalar furthest_within(Scalar x, double support) {
  auto other = static_cast<Scalar>(static_cast<double>(x) + support);
  while (static_cast<double>(other) - static_cast<double>(x) > support)
    other = std::nextafter(other, std::numeric_limits<Scalar>::lowest());
  return other;
}

// The worst pair at every border between two cells: one particle at the last coordinate before it, the other as far on
// as H allows. In single precision the margin of 1e-5 covers the rounding of the product up to 511 H from the origin.
TYPED_TEST(Grid, WorstPairsAtEveryBorderStayWithinReach) {
  using Real = TypeParam;
  for (const double support : {0.044444444444444446, 0.0457, 0.1, 2.0 / 3, 0.0024180}) {
    const auto inverse_x = static_cast<Real>(k_x_fineness / (support * (1 + 1e-5)));
    const auto inverse_yz = static_cast<Real>(1 / (support * (1 + 1e-5)));
    for (int border = 1; border < 511 * k_x_fineness; ++border)
      for (const bool along_x : {true, false}) {
        if (!along_x && border >= 511) continue;
        const Real inverse = along_x ? inverse_x : inverse_yz;
        auto before = static_cast<Real>(border / static_cast<double>(inverse));
        while (cell_coordinate(before, inverse, 1 << 20) >= border) before = std::nextafter(before, Real(0));
        while (cell_coordinate(std::nextafter(before, Real(1e9)), inverse, 1 << 20) < border)
          before = std::nextafter(before, Real(1e9));
        const Real beyond = furthest_within(before, support);
        ASSERT_LE(cell_coordinate(beyond, inverse, 1 << 20) - cell_coordinate(before, inverse, 1 << 20),
                  along_x ? k_x_fineness : 1)
            << "border " << border << ", H = " << support;
      }
  }
}

TYPED_TEST(Grid, RandomPairsStayWithinReach) {
  using Real = TypeParam;
  std::mt19937 random(5);
  const double support = 0.044444444444444446;
  const auto params = grid_params<Real>(support, 300, 1, 1);
  std::uniform_real_distribution<double> place(-2 * support, 160 * support), unit(0.0, 1.0);
  for (int i = 0; i < 200000; ++i) {
    const Real x = static_cast<Real>(place(random));
    // half of the pairs nearly H apart
    const double distance = support * (i % 2 ? unit(random) : 1 - 1e-6 * unit(random));
    const Real other = furthest_within(x, distance);
    const int cells = std::abs(cell_of(&params, other, Real(0), Real(0)) - cell_of(&params, x, Real(0), Real(0)));
    ASSERT_LE(cells, k_x_fineness) << "from " << x << " to " << other;
  }
}

}  // namespace
}  // namespace squall::test
