// Smoothing kernels against values computed elsewhere, printed to nine decimals, at H = 1 (docs/physics.md).
#include "sph_formulas.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/numbers.h"

namespace squall::test {
namespace {

template <class Real>
class SmoothingKernels : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SmoothingKernels, Reals);

struct Golden {
  double q;
  double poly6, poly6_slope;
  double spiky, spiky_slope;
  double cubic, cubic_slope;
  double viscosity_laplacian;
  double bell, bell_slope;
};

const std::vector<Golden>& golden_values() {
  static const std::vector<Golden> values = {
      {0.00, 1.566681471, 0.0, 4.774648293, -14.323944878, 2.546479089, 0.0, 14.323944878, 2.533617691, 0.0},
      {0.10, 1.520149465, -0.921302706, 3.480718605, -11.602395351, 2.408969219, -2.597408671, 12.891550390,
       2.407925742, -2.458046517},
      {0.25, 1.290905753, -2.065449205, 2.014304749, -8.057218994, 1.830281846, -4.774648293, 10.742958659, 1.833775686,
       -4.835357593},
      {0.50, 0.660943746, -2.643774982, 0.596831037, -3.580986220, 0.636619772, -3.819718634, 7.161972439, 0.641983567,
       -3.813981048},
      {0.75, 0.131194274, -1.349426814, 0.074603880, -0.895246555, 0.079577472, -0.954929659, 3.580986220, 0.077870826,
       -0.927200726},
      {0.90, 0.010745868, -0.305408886, 0.004774648, -0.143239449, 0.005092958, -0.152788745, 1.432394488, 0.005455277,
       -0.157385011},
      {1.00, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
  };
  return values;
}

// The formulas leave constant factors out; each is multiplied in double. Scales of the tolerances are those factors
// times the largest intermediate value (all powers of u, w, t <= 1; the cubic spline subtracts values up to 2).
TYPED_TEST(SmoothingKernels, MatchGoldenValues) {
  using Real = TypeParam;
  for (const Golden& golden : golden_values()) {
    SCOPED_TRACE(golden.q);
    const Real q = static_cast<Real>(golden.q);
    const Real u = remaining_support(q, Real(1));
    const Real w = remaining_support(q, Real(2));
    const Real t = squared_support_left(q, Real(0), Real(0), Real(1));
    auto expect = [](double factor, Real value, double expected, double scale) {
      EXPECT_NEAR(factor * value, expected, printed(9) + rounding<Real>(8, factor * scale));
    };
    expect(315 / (64 * k_pi), poly6_value(t), golden.poly6, 1);
    expect(-945 / (32 * k_pi) * golden.q, poly6_slope(t), golden.poly6_slope, 1);
    expect(15 / k_pi, spiky_value(u), golden.spiky, 1);
    expect(-45 / k_pi, spiky_slope(u), golden.spiky_slope, 1);
    expect(8 / k_pi, cubic_value(u, w), golden.cubic, 2);
    expect(-48 / k_pi, cubic_slope(u, w), golden.cubic_slope, 1);
    expect(45 / k_pi, viscosity_laplacian(u), golden.viscosity_laplacian, 1);
    const Real left = bell_left(q * q, Real(1));
    expect(315 / (8192 * k_pi), bell_value(left), golden.bell, 207);
    expect(-945 / (2048 * k_pi) * golden.q, bell_weight(left), golden.bell_slope, 175);
  }
}

TYPED_TEST(SmoothingKernels, AreExactAtTheEndsOfTheSupport) {
  using Real = TypeParam;
  EXPECT_EQ(cubic_value(Real(1), Real(1)), Real(1));
  EXPECT_EQ(cubic_slope(Real(1), Real(1)), Real(0)) << "no force between coincident particles";
  EXPECT_EQ(bell_value(bell_left(Real(0), Real(1))), Real(207));
  EXPECT_EQ(bell_weight(bell_left(Real(0), Real(1))), Real(175)) << "finite, and x_i - x_j is zero";
  for (const Real q : {Real(1), std::nextafter(Real(1), Real(2)), Real(1.5), Real(1e30)}) {
    SCOPED_TRACE(q);
    const Real u = remaining_support(q, Real(1));
    const Real w = remaining_support(q, Real(2));
    const Real t = squared_support_left(q, Real(0), Real(0), Real(1));
    const Real left = bell_left(q * q, Real(1));
    for (const Real value : {cubic_value(u, w), cubic_slope(u, w), poly6_value(t), poly6_slope(t), spiky_value(u),
                             spiky_slope(u), viscosity_laplacian(u), bell_value(left), bell_weight(left)}) {
      EXPECT_EQ(value, Real(0));
      EXPECT_FALSE(std::signbit(value)) << "a candidate outside the support must add exactly +0";
    }
  }
}

// At r = H(1 - e) the values are of order e^2 and e^3, and the two pieces of the cubic spline meet at r = H/2.
TYPED_TEST(SmoothingKernels, VanishTowardsTheSupportAndJoinAtTheKnot) {
  using Real = TypeParam;
  const double support = 0.0457;  // no power of two: 1/H is rounded
  const Real inverse = static_cast<Real>(1 / support);
  const Real inverse_half = static_cast<Real>(2 / support);
  // r, 1/H and their product are rounded: u may be off by this much
  const double slack = rounding<Real>(2);
  for (const double below : {0.0, 1e-7, 1e-6}) {
    SCOPED_TRACE(below);
    const Real r = static_cast<Real>(support * (1 - below));
    const Real u = remaining_support(r, inverse);
    EXPECT_NEAR(u, below, slack);
    EXPECT_LE(cubic_value(u, remaining_support(r, inverse_half)), 2.01 * std::pow(below + slack, 3));
    EXPECT_LE(cubic_slope(u, remaining_support(r, inverse_half)), 1.01 * std::pow(below + slack, 2));
  }
  const Real knot = static_cast<Real>(support / 2);
  const Real u = remaining_support(knot, inverse);
  const Real w = remaining_support(knot, inverse_half);
  EXPECT_NEAR(cubic_value(u, w), 0.25, rounding<Real>(8, 0.25));
  EXPECT_NEAR(cubic_slope(u, w), 0.25, rounding<Real>(8, 0.25));
}

// Slopes are derivatives of values: central differences in double, whose error is h^2/6 max|W'''| + eps max|W|/h.
TEST(SmoothingKernelSlopes, AreDerivativesOfTheValues) {
  const double step = 1e-5;
  const double tolerance = step * step / 6 * 200 + rounding<double>(8, 2) / step;
  auto cubic = [](double q) { return cubic_value(remaining_support(q, 1.0), remaining_support(q, 2.0)); };
  auto poly6 = [](double q) { return poly6_value(squared_support_left(0.0, q, 0.0, 1.0)); };
  auto spiky = [](double q) { return spiky_value(remaining_support(q, 1.0)); };
  auto bell = [](double q) { return bell_value(bell_left(q * q, 1.0)) / 64; };
  for (int i = 1; i < 120; ++i) {
    const double q = i / 100.0 + 0.003;
    SCOPED_TRACE(q);
    auto difference = [&](auto f) { return (f(q + step) - f(q - step)) / (2 * step); };
    EXPECT_NEAR(difference(cubic), -6 * cubic_slope(remaining_support(q, 1.0), remaining_support(q, 2.0)), tolerance);
    EXPECT_NEAR(difference(poly6), -6 * q * poly6_slope(squared_support_left(0.0, 0.0, q, 1.0)), tolerance);
    EXPECT_NEAR(difference(spiky), -3 * spiky_slope(remaining_support(q, 1.0)), tolerance);
    EXPECT_NEAR(difference(bell), -12. / 64 * q * bell_weight(bell_left(q * q, 1.0)), tolerance);
  }
}

// Simpson's rule with n = 4000 over 4 pi r^2 W; its error h^4/180 max|f''''| stays below 1e-10 (the knot of the spline
// is a grid point).
TEST(SmoothingKernelIntegrals, AreOne) {
  auto integral = [](auto kernel) {
    const int n = 4000;
    double sum = 0;
    for (int i = 0; i <= n; ++i) {
      const double q = static_cast<double>(i) / n;
      sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * 4 * k_pi * q * q * kernel(q);
    }
    return sum / (3.0 * n);
  };
  auto cubic = [](double q) { return cubic_value(remaining_support(q, 1.0), remaining_support(q, 2.0)); };
  EXPECT_NEAR(8 / k_pi * integral(cubic), 1, 1e-10);
  EXPECT_NEAR(315 / (64 * k_pi) * integral([](double q) { return poly6_value(1 - q * q); }), 1, 1e-10);
  EXPECT_NEAR(15 / k_pi * integral([](double q) { return spiky_value(1 - q); }), 1, 1e-10);
  const auto bell = [](double q) { return 315 / (8192 * k_pi) * bell_value(bell_left(q * q, 1.0)); };
  EXPECT_NEAR(integral(bell), 1, 1e-10);
  EXPECT_NEAR(integral([&](double q) { return q * q * bell(q); }), 42. / 187, 1e-10) << "dfsph's viscosity rests on it";
}

TYPED_TEST(SmoothingKernels, MaximumWithZeroWorksOnBits) {
  using Real = TypeParam;
  const Real infinity = std::numeric_limits<Real>::infinity();
  const Real smallest = std::numeric_limits<Real>::denorm_min();
  for (const Real value : {Real(1.5), smallest, std::numeric_limits<Real>::max(), infinity})
    EXPECT_EQ(max0(value), value);
  for (const Real value : {Real(0), -Real(0), Real(-1.5), -smallest, -infinity,
                           std::copysign(std::numeric_limits<Real>::quiet_NaN(), Real(-1))}) {
    EXPECT_EQ(max0(value), Real(0));
    EXPECT_FALSE(std::signbit(max0(value)));
  }
}

TYPED_TEST(SmoothingKernels, LengthsAndProductsAddUp) {
  using Real = TypeParam;
  EXPECT_EQ(squared_length(Real(2), Real(-3), Real(6)), Real(49));
  EXPECT_EQ(dot_product(Real(1), Real(2), Real(3), Real(-4), Real(5), Real(-6)), Real(-12));
  EXPECT_EQ(squared_support_left(Real(2), Real(-3), Real(6), Real(50)), Real(1));
  EXPECT_EQ(squared_support_left(Real(2), Real(-3), Real(6), Real(48)), Real(0));
}

}  // namespace
}  // namespace squall::test
