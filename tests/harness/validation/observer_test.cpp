#include "harness/validation/observer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "backends.h"
#include "core/errors.h"
#include "core/frame_plan.h"
#include "support/scenes.h"

namespace squall::harness {
namespace {

double last(const TimeSeries& series, const std::string& name) {
  const Column* column = series.find(name);
  return column == nullptr || column->value.empty() ? std::nan("") : column->value.back();
}

/// Observes `frames` frames of a scene.
TimeSeries observed(const Scene& scene, Pressure pressure, int frames) {
  Settings settings;
  settings.pressure = pressure;
  settings.precision = Precision::double_precision;
  const auto solver = make_solver("reference", scene, settings);
  Observer observer(scene, pressure, 1);
  observer.add(solver->state(), nullptr);
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport report = solver->advance();
    observer.add(solver->state(), &report);
  }
  return observer.series();
}

Scene small_tank(int layers) {
  Scene scene = test::filled_tank(layers);
  scene.container.max_m = {0.2, 0.6, 0.2};
  scene.blocks[0].max_m = {0.2, layers * 0.05, 0.2};
  scene.container.open_top = true;
  return scene;
}

/// Of two particles everything is known.
TEST(Observer, SumsUpTwoParticles) {
  Particles pair;
  pair.add(0, {0.2, 0.3, 0.2}, {0.0, 1.0, 0.0});
  pair.add(1, {0.6, 0.3, 0.2}, {0.0, -1.0, 0.0});
  Scene scene = test::tank_with(pair);
  scene.gravity_m_s2.setZero();
  State state;
  state.particles = pair;
  Observer observer(scene, Pressure::wcsph, 1);
  observer.add(state, nullptr);
  const TimeSeries& series = observer.series();
  const double m = scene.particle_mass();
  EXPECT_NEAR(last(series, "kinetic_j"), m, 1e-12);
  EXPECT_NEAR(last(series, "momentum_y_kg_m_s"), 0.0, 1e-12);
  EXPECT_NEAR(last(series, "angular_momentum_z_kg_m2_s"), -0.4 * m, 1e-12);
  EXPECT_NEAR(last(series, "x_rms_m"), 0.2, 1e-12);
  EXPECT_NEAR(last(series, "x_max_m"), 0.625, 1e-12);
  EXPECT_NEAR(last(series, "x_min_m"), 0.175, 1e-12);
  EXPECT_TRUE(std::isnan(last(series, "depth_m")));  // neither has a neighbour
  EXPECT_EQ(last(series, "filled_depth_m"), 0.0);
}

/// Free fall is exact in leap-frog: energies and velocities are those of the half step they are said to belong to. 60
/// frames of up to 100 sub-steps in double: 1e4 roundings of 1e-16.
TEST(Observer, TakesVelocitiesWhereTheyBelong) {
  Particles one;
  one.add(0, {0.4, 0.5, 0.2}, {0.5, 0.0, 0.0});
  const Scene scene = test::tank_with(one);
  const TimeSeries series = observed(scene, Pressure::wcsph, 12);
  const Column& speed = *series.find("vy_cm_m_s");
  const Column& energy = *series.find("energy_j");
  const Column& force = *series.find("wall_force_y_n");
  for (std::size_t i = 0; i < speed.value.size(); ++i) {
    EXPECT_NEAR(speed.value[i], -9.81 * speed.time_s[i], 1e-10);
    // x(t - dt/2) by v dt/2 is off by g dt^2/8.
    EXPECT_NEAR(energy.value[i] / energy.value[0], 1.0, 1e-5);
  }
  for (const double value : force.value) EXPECT_NEAR(value, 0.0, 1e-9);
}

TEST(Observer, ForceOfTheFloorCarriesTheWeight) {
  Scene scene = small_tank(4);
  scene.fluid.viscosity_m2_s = 0.05;
  const TimeSeries series = observed(scene, Pressure::dfsph, 40);
  const double weight = 9.81 * scene.particle_mass() * 64;
  const Column& force = *series.find("wall_force_y_n");
  double mean = 0.0;
  for (std::size_t i = 20; i < 40; ++i) mean += force.value[i] / 20.0;
  // The change of momentum over the 20 frames: a thousandth of the weight is 3 mm/s.
  EXPECT_NEAR(mean / weight, 1.0, 1e-2);
  EXPECT_NEAR(last(series, "filled_depth_m"), 0.2, 1e-12);
  EXPECT_NEAR(last(series, "depth_m"), 0.2, 0.05);
}

/// A container that moves carries nothing but its own acceleration into the balance.
TEST(Observer, KnowsTheContainersFrame) {
  Particles one;
  one.add(0, {0.4, 0.5, 0.2}, {0.0, 0.0, 0.0});
  Scene scene = test::tank_with(one);
  scene.container.motions.push_back({0.0, 1.0, Eigen::Vector3d(0.3, 0.0, 0.0), {}});
  const TimeSeries series = observed(scene, Pressure::wcsph, 10);
  for (const double value : series.find("wall_force_x_n")->value) EXPECT_NEAR(value, 0.0, 1e-9);
}

/// Sums of nothing are 0; everything else needs something to be measured of.
TEST(Observer, GivesNoValueWhereThereIsNothingToMeasure) {
  Scene scene = test::empty_tank();
  scene.gauges = {
      {"p", {0.4, 0.3, 0.2}, "pressure"}, {"v", {0.4, 0.3, 0.2}, "velocity"}, {"l", {0.4, 0, 0.2}, "level"}};
  const TimeSeries series = observed(scene, Pressure::wcsph, 2);
  for (const auto& quantity : quantities()) {
    const double value = last(series, quantity.name);
    EXPECT_EQ(std::isnan(value), !quantity.needs.empty()) << quantity.name;
    if (quantity.needs.empty()) {
      EXPECT_EQ(value, 0.0) << quantity.name;
    }
    EXPECT_FALSE(series.find(quantity.name)->value.empty()) << quantity.name;
  }
  EXPECT_TRUE(std::isnan(last(series, "v_x")));
  EXPECT_EQ(last(series, "p"), 0.0);  // the air's
  EXPECT_EQ(last(series, "l"), 0.0);  // the floor's
  ASSERT_EQ(series.find("p")->is_dry.size(), series.find("p")->value.size());
  EXPECT_TRUE(is_dry_at(*series.find("p"), 1.0 / 60));
}

TEST(Observer, KnowsWhenAPressureGaugeStandsInWater) {
  Scene scene = small_tank(4);
  scene.gauges = {{"low", {0.1, 0.0, 0.1}, "pressure"}, {"high", {0.1, 0.55, 0.1}, "pressure"}};
  const TimeSeries series = observed(scene, Pressure::dfsph, 2);
  EXPECT_FALSE(is_dry_at(*series.find("low"), 0.02));
  EXPECT_TRUE(is_dry_at(*series.find("high"), 0.02));
}

TEST(QuantityNames, RefuseAGaugeCalledLikeAQuantity) {
  Scene scene = small_tank(1);
  scene.gauges.push_back({"p", {0.1, 0.0, 0.1}, "level"});
  EXPECT_EQ(quantity_names(scene).back(), "p");
  scene.gauges.push_back({"front_m", {0.1, 0.0, 0.1}, "level"});
  EXPECT_THROW(quantity_names(scene), InputError);
}

TEST(Observer, AveragesPressuresOverSamples) {
  Scene scene = small_tank(4);
  scene.gauges.push_back({"p", {0.1, 0.0, 0.1}, "pressure"});
  Observer observer(scene, Pressure::dfsph, 2);
  State state;
  state.particles = initial_particles(scene);
  observer.add(state, nullptr);
  std::vector<double> single;
  for (int frame = 1; frame <= 4; ++frame) {
    state.clock.frame = static_cast<std::uint64_t>(frame);
    state.clock.previous_dt = 1e-3;
    state.particles.pressures.assign(state.particles.size(), frame);
    single.push_back(Gauges(scene, Pressure::dfsph).read(state).front());
    observer.add(state, nullptr);
  }
  const Column& column = *observer.series().find("p");
  ASSERT_EQ(column.value.size(), 2u);
  EXPECT_NEAR(column.value[0], 0.5 * (single[0] + single[1]), 1e-9 * single[1]);
  EXPECT_NEAR(column.time_s[0], 1.5 / 60, 1e-12);
  EXPECT_NEAR(column.time_s[1], 3.5 / 60, 1e-12);
}

}  // namespace
}  // namespace squall::harness
