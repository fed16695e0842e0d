// Pressures, pair forces and air: against closed forms and against Müller's model worked out by hand for two and three
// particles (docs/physics.md).
#include "sph_formulas.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "support/numbers.h"

namespace squall::test {
namespace {

template <class Real>
class Formulas : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Formulas, Reals);

// ---- Müller's model for a few particles on the x axis
// -------------------------------------------------------------------

// Kelager's water. Formulas work with relative densities and p/rho0: a mass m has the volume m/rho0.
constexpr double k_mass = 0.02, k_support = 0.0457, k_stiffness = 3, k_rest_density = 998.29, k_viscosity = 3.5;

struct Row {
  std::vector<double> x, velocity;
};

struct Outcome {
  std::vector<double> density, pressure, pressure_acceleration, viscous_acceleration;
  std::vector<double> acceleration_scale;  // sum of the magnitudes that cancel in pressure_acceleration
};

template <class Real>
Outcome mueller(const Row& row) {
  const double volume = k_mass / k_rest_density;
  const Real density_scale = static_cast<Real>(volume * 315 / (64 * k_pi * std::pow(k_support, 9)));
  const double force_scale = volume * 45 / (k_pi * std::pow(k_support, 4));
  const double viscosity_scale = 2 * k_viscosity / k_rest_density * volume * 45 / (k_pi * std::pow(k_support, 5));
  const Real support_squared = static_cast<Real>(k_support * k_support);
  const std::size_t n = row.x.size();
  std::vector<Real> density(n), pressure(n), half_volume(n);
  for (std::size_t i = 0; i < n; ++i) {
    Real sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const Real x = static_cast<Real>(row.x[i]) - static_cast<Real>(row.x[j]);
      sum += poly6_value(squared_support_left(x, Real(0), Real(0), support_squared));
    }
    density[i] = relative_density(sum, density_scale, Real(0));
    pressure[i] = mueller_pressure(density[i], Real(k_stiffness), Real(1));
    half_volume[i] = Real(1) / (density[i] + density[i]);
  }
  Outcome out;
  for (std::size_t i = 0; i < n; ++i) {
    double force = 0, force_magnitude = 0, drag = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const Real x = static_cast<Real>(row.x[i]) - static_cast<Real>(row.x[j]);
      const Real u = remaining_support(std::abs(x), static_cast<Real>(1 / k_support));
      const Real factor =
          mueller_pair(std::abs(x), u, pressure[i], half_volume[j], pressure[j] * half_volume[j], Real(1e-20));
      force += static_cast<double>(factor * x);
      force_magnitude += std::abs(static_cast<double>(factor * x));
      drag += (row.velocity[j] - row.velocity[i]) * static_cast<double>(half_volume[j] * viscosity_laplacian(u));
    }
    out.density.push_back(density[i] * k_rest_density);
    out.pressure.push_back(pressure[i] * k_rest_density);
    out.pressure_acceleration.push_back(force * force_scale / density[i]);
    out.viscous_acceleration.push_back(drag * viscosity_scale / density[i]);
    out.acceleration_scale.push_back(force_magnitude * force_scale / density[i]);
  }
  return out;
}

// Roundings: a density has about 12 (three fma and two products of t^3, twice that for the relative error that H^2 -
// r^2 magnifies at r = 0.9 H, scale and sum), a pressure two more on top of rho - 1, an acceleration adds density,
// pressure and 8 of its own.
constexpr double k_density_roundings = 32, k_force_roundings = 4 * k_density_roundings;

template <class Real>
void expect_densities_and_pressures(const Outcome& out, const std::vector<double>& density,
                                    const std::vector<double>& pressure, int digits) {
  for (std::size_t i = 0; i < density.size(); ++i) {
    SCOPED_TRACE(i);
    const double scale = density[i] + k_rest_density;
    EXPECT_NEAR(out.density[i], density[i], printed(digits) + rounding<Real>(k_density_roundings, scale));
    EXPECT_NEAR(out.pressure[i], pressure[i],
                printed(digits) + rounding<Real>(k_density_roundings, k_stiffness * scale));
  }
}

TYPED_TEST(Formulas, MuellerPairMatchesGoldenValues) {
  using Real = TypeParam;
  const Outcome out = mueller<Real>({{0, k_support / 2}, {0, 1}});
  expect_densities_and_pressures<Real>(out, {466.7921252340394, 466.7921252340394},
                                       {-1594.4936242978815, -1594.4936242978815}, 9);
  const double pull = 120.15548211521714, drag = 11.542573355775765;
  EXPECT_NEAR(out.pressure_acceleration[0], pull, rounding<Real>(k_force_roundings, pull));
  EXPECT_NEAR(out.pressure_acceleration[1], -pull, rounding<Real>(k_force_roundings, pull));
  EXPECT_NEAR(out.viscous_acceleration[0], drag, rounding<Real>(k_force_roundings, drag));
  EXPECT_NEAR(out.viscous_acceleration[1], -drag, rounding<Real>(k_force_roundings, drag));
}

TYPED_TEST(Formulas, MuellerTripleMatchesGoldenValues) {
  using Real = TypeParam;
  const Outcome out = mueller<Real>({{0, 0.3 * k_support, 0.9 * k_support}, {0, 0, 0}});
  expect_densities_and_pressures<Real>(out, {577.93748468, 661.7458558, 416.60526228},
                                       {-1261.05754597, -1009.6324326, -1745.05421317}, 7);
  const std::vector<double> expected = {99.63890281, -43.03699329, -56.60190952};
  double force = 0, force_scale = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double bound = rounding<Real>(k_force_roundings, out.acceleration_scale[i]);
    EXPECT_NEAR(out.pressure_acceleration[i], expected[i], printed(8) + bound) << i;
    // Müller's symmetric form divides by rho_j, and a by rho_i: m a adds up to nothing
    force += out.pressure_acceleration[i];
    force_scale += out.acceleration_scale[i];
  }
  EXPECT_NEAR(force, 0, rounding<Real>(k_force_roundings, force_scale));
}

TEST(Formulas, AnIsolatedParticleHasItsOwnDensity) {
  EXPECT_NEAR(mueller<double>({{0}, {0}}).density[0], 328.293, printed(3));
}

// ---- pressures
// ----------------------------------------------------------------------------------------------------------

TYPED_TEST(Formulas, TaitPressureIsTheSeventhPower) {
  using Real = TypeParam;
  const Real stiffness = Real(57);
  for (const double density : {1.0, 1.001, 1.01, 1.1, 1.5, 2.0, 3.6}) {
    const double exact = static_cast<double>(stiffness) * (std::pow(static_cast<Real>(density), 7.0) - 1);
    EXPECT_NEAR(tait_pressure(static_cast<Real>(density), stiffness), exact,
                rounding<Real>(6, static_cast<double>(stiffness) * std::pow(density, 7)));
  }
  for (const double density : {1.0, 0.999, 0.5, 0.0})
    EXPECT_EQ(tait_pressure(static_cast<Real>(density), stiffness), Real(0)) << density;
}

TYPED_TEST(Formulas, MuellerPressureIsLinearAndClampedUnlessTensionIsKept) {
  using Real = TypeParam;
  EXPECT_EQ(mueller_pressure(Real(1.5), Real(400), Real(0)), Real(200));
  EXPECT_EQ(mueller_pressure(Real(1.5), Real(400), Real(1)), Real(200));
  EXPECT_EQ(mueller_pressure(Real(0.5), Real(400), Real(0)), Real(0));
  EXPECT_EQ(mueller_pressure(Real(0.5), Real(400), Real(1)), Real(-200));
  EXPECT_EQ(mueller_pressure(Real(1), Real(400), Real(0)), Real(0));
}

TYPED_TEST(Formulas, RelativeDensityAddsTheWalls) {
  using Real = TypeParam;
  EXPECT_EQ(relative_density(Real(3), Real(0.25), Real(0.125)), Real(0.875));
}

// ---- pair forces
// --------------------------------------------------------------------------------------------------------

// Against the textbook form (P_i + P_j + shear (V_i + V_j)/(r^2 + e)) slope/r in long double, for random arguments.
TYPED_TEST(Formulas, WcsphPairIsTheTextbookForm) {
  using Real = TypeParam;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Real r = static_cast<Real>(0.001 + 0.04 * unit(random)), r2 = r * r;
    const Real slope = static_cast<Real>(unit(random)), pressures = static_cast<Real>(500 * unit(random));
    const Real volumes = static_cast<Real>(1.5 + unit(random)), shear = static_cast<Real>(unit(random) - 0.5);
    const Real softening = Real(5e-6), tiny = Real(1e-20);
    using Wide = long double;
    const Wide viscous = Wide(shear) * Wide(volumes) / (Wide(r2) + Wide(softening));
    const Wide exact = (Wide(pressures) + viscous) * Wide(slope) / Wide(r);
    const double scale = static_cast<double>((Wide(pressures) + std::abs(viscous)) * Wide(slope) / Wide(r));
    EXPECT_NEAR(wcsph_pair(r, r2, slope, pressures, volumes, shear, softening, tiny), static_cast<double>(exact),
                rounding<Real>(8, scale));
  }
}

TYPED_TEST(Formulas, CoincidentParticlesFeelNothing) {
  using Real = TypeParam;
  const Real slope = cubic_slope(Real(1), Real(1));
  const Real x = 0;
  EXPECT_EQ(wcsph_pair(Real(0), Real(0), slope, Real(100), Real(2), Real(1), Real(5e-6), Real(1e-20)) * x, Real(0));
  const Real spiky = mueller_pair(Real(0), Real(1), Real(100), Real(0.5), Real(50), Real(1e-20));
  EXPECT_TRUE(std::isfinite(spiky));
  EXPECT_EQ(spiky * x, Real(0));
}

TYPED_TEST(Formulas, PairsOutsideTheSupportAddExactlyNothing) {
  using Real = TypeParam;
  const Real r = Real(0.05);
  EXPECT_EQ(wcsph_pair(r, r * r, Real(0), Real(100), Real(2), Real(0), Real(5e-6), Real(1e-20)), Real(0));
  EXPECT_EQ(mueller_pair(r, Real(0), Real(100), Real(0.5), Real(50), Real(1e-20)), Real(0));
}

// ---- air
// ----------------------------------------------------------------------------------------------------------------

TYPED_TEST(Formulas, DragBalancesGravityAtTerminalSpeed) {
  using Real = TypeParam;
  const double terminal = 6.49, gravity = 9.81;
  const Real coefficient = static_cast<Real>(gravity / (terminal * terminal));
  // whatever the direction: |v| = terminal
  const std::array<double, 3> v = {terminal * 2 / 7, -terminal * 6 / 7, terminal * 3 / 7};
  const Real rate =
      drag_rate(static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2]), coefficient, Real(1));
  EXPECT_NEAR(static_cast<double>(rate) * terminal, -gravity, rounding<Real>(8, gravity));
  EXPECT_EQ(drag_rate(Real(1), Real(2), Real(2), coefficient, Real(0)), Real(0));
  EXPECT_EQ(drag_rate(Real(1), Real(2), Real(2), Real(0.5), Real(1)), Real(-1.5));
}

TYPED_TEST(Formulas, IsolationIsOneOrZeroAndNothingBetween) {
  using Real = TypeParam;
  const Real self = Real(1), scale = Real(0.318), steepness = Real(1 << 30);
  EXPECT_EQ(isolation(self, self, scale, Real(0), steepness), Real(1));
  // a neighbour or a wall that single precision can see at all
  const Real touched = static_cast<Real>(std::nextafter(1.0f, 2.0f));
  EXPECT_EQ(isolation(touched, self, scale, Real(0), steepness), Real(0));
  EXPECT_EQ(isolation(self, self, scale, Real(1e-7), steepness), Real(0));
  EXPECT_EQ(isolation(Real(3), self, scale, Real(0.5), steepness), Real(0));
}

}  // namespace
}  // namespace squall::test
