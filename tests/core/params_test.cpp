// The constants of a run: grids that hold their promise after rounding to single precision, scales that give a lattice
// rest density.
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "core/frame_plan.h"
#include "grid.h"
#include "sph_formulas.h"
#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

// At every border between two cells of a tank 3,000 H long: a particle on the last float before it and one as far on as
// H allows.
TEST(Params, TwoParticlesWithinSupportAreNeverTooManyCellsApart) {
  for (const double spacing : {0.05, 0.0222222222, 0.0024180}) {
    Scene scene = empty_tank();
    scene.fluid.spacing_m = spacing;
    const double support = scene.support_radius();
    scene.container.max_m = {3000 * support, 3 * support, 3 * support};
    const Params<float> params = to_single(make_params(scene, Pressure::wcsph));
    for (int border = 1; border < params.cells_x; ++border) {
      auto before = static_cast<float>(border / static_cast<double>(params.inverse_edge_x));
      while (cell_coordinate(before, params.inverse_edge_x, params.cells_x) >= border)
        before = std::nextafter(before, 0.0f);
      while (cell_coordinate(std::nextafter(before, 1e9f), params.inverse_edge_x, params.cells_x) < border)
        before = std::nextafter(before, 1e9f);
      auto beyond = static_cast<float>(before + support);
      while (static_cast<double>(beyond) - before > support) beyond = std::nextafter(beyond, 0.0f);
      ASSERT_LE(cell_coordinate(beyond, params.inverse_edge_x, params.cells_x) - (border - 1), k_x_fineness)
          << "border " << border;
    }
  }
}

TEST(Params, TheGridCoversTheContainer) {
  for (const double spacing : {0.05, 0.0222222222, 0.03}) {
    Scene scene = empty_tank();
    scene.fluid.spacing_m = spacing;
    const Params<double> params = make_params(scene, Pressure::wcsph);
    const double edge = 1 / params.inverse_edge_yz;
    EXPECT_GT(params.cells_x * edge / k_x_fineness, 0.8);
    EXPECT_GT(params.cells_y * edge, 0.6);
    EXPECT_GT(params.cells_z * edge, 0.4);
    EXPECT_LE((params.cells_z - 1) * edge, 0.4);
    EXPECT_EQ(params.cell_count, params.cells_x * params.cells_y * params.cells_z);
  }
}

TEST(Params, AGridTooLargeIsRefusedWithItsSize) {
  Scene scene = empty_tank();
  scene.container.max_m = {1000, 1000, 1000};
  try {
    make_params(scene, Pressure::wcsph);
    FAIL() << "10,000^3 cells";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cells"), std::string::npos) << error.what();
  }
}

// rho = rho0 exactly on a lattice: m = rho0 dx^3 and every density sum is divided by its lattice sum.
TEST(Params, ALatticeHasRestDensity) {
  for (const double ratio : {1.6, 2.0, 2.5})
    for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph}) {
      Scene scene = empty_tank();
      scene.fluid.support_ratio = ratio;
      const Params<double> params = make_params(scene, pressure);
      double sum = 0;
      for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j)
          for (int k = -3; k <= 3; ++k) {
            const double x = 0.05 * i, y = 0.05 * j, z = 0.05 * k;
            const double r2 = squared_length(x, y, z), r = std::sqrt(r2);
            if (pressure == Pressure::dfsph) sum += bell_value(bell_left(r2, params.inverse_support_squared));
            if (pressure == Pressure::mueller)
              sum += poly6_value(squared_support_left(x, y, z, params.support_squared));
            if (pressure == Pressure::wcsph)
              sum += cubic_value(remaining_support(r, params.inverse_support),
                                 remaining_support(r, params.inverse_half_support));
          }
      EXPECT_NEAR(relative_density(sum, params.density_scale, 0.0), 1, rounding<double>(343 + 16, 1)) << ratio;
    }
}

TEST(Params, ModelCoefficientsAreAsDefined) {
  Scene scene = filled_tank(6);
  scene.fluid.viscosity_m2_s = 0.02;
  const double depth = 0.3, support = 0.1, tolerance = 1e-13;
  const Params<double> wcsph = make_params(scene, Pressure::wcsph);
  EXPECT_NEAR(wcsph.stiffness / (100 * 9.81 * depth / 7), 1, tolerance);
  EXPECT_NEAR(wcsph.artificial_scale / (0.1 * support / 2 * 10 * std::sqrt(9.81 * depth) / 2), 1, tolerance);
  EXPECT_NEAR(wcsph.viscosity_scale, 5 * 0.02, tolerance);
  EXPECT_NEAR(wcsph.clamp_distance, 0.01 * 0.05, tolerance);
  EXPECT_NEAR(wcsph.lost_distance, 6, tolerance);
  EXPECT_EQ(wcsph.drag_coefficient, 0);
  const Params<double> mueller = make_params(scene, Pressure::mueller);
  EXPECT_EQ(mueller.stiffness, 400);
  EXPECT_EQ(mueller.tension, 0);
  scene.solver.negative_pressure = true;
  EXPECT_EQ(make_params(scene, Pressure::mueller).tension, 1);
}

// A particle alone must be recognised as such in single precision too: its kernel sum equals self_value to the bit.
TEST(Params, SelfValueIsWhatAParticleAloneSumsTo) {
  for (const double spacing : {0.05, 0.0222222222, 0.0024180}) {
    Scene scene = empty_tank();
    scene.fluid.spacing_m = spacing;
    const Params<float> wcsph = to_single(make_params(scene, Pressure::wcsph));
    EXPECT_EQ(wcsph.self_value, cubic_value(1.0f, 1.0f));
    const Params<float> dfsph = to_single(make_params(scene, Pressure::dfsph));
    EXPECT_EQ(dfsph.self_value, bell_value(bell_left(0.0f, dfsph.inverse_support_squared)));
    const Params<float> mueller = to_single(make_params(scene, Pressure::mueller));
    EXPECT_EQ(mueller.self_value, poly6_value(squared_support_left(0.0f, 0.0f, 0.0f, mueller.support_squared)));
  }
}

}  // namespace
}  // namespace squall::test
