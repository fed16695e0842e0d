#include "harness/gauges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "support/scenes.h"

namespace squall::harness {
namespace {

State start_of(const Scene& scene) {
  State state;
  state.particles = initial_particles(scene);
  return state;
}

Scene with_gauge(Scene scene, const std::string& kind, const Eigen::Vector3d& position) {
  scene.gauges.push_back({"g", position, kind});
  return scene;
}

double read_one(const Scene& scene, const State& state, Pressure pressure = Pressure::wcsph) {
  return Gauges(scene, pressure).read(state).front();
}

/// dx = 0.05 m, four layers: the last at 0.175 m.
TEST(LevelGauge, IsTheTopOfTheColumn) {
  const Scene scene = with_gauge(test::filled_tank(4), "level", {0.4, 0.0, 0.2});
  EXPECT_NEAR(read_one(scene, start_of(scene)), 0.2, 1e-12);
}

TEST(LevelGauge, LeavesSprayOut) {
  const Scene scene = with_gauge(test::filled_tank(4), "level", {0.4, 0.0, 0.2});
  State state = start_of(scene);
  const auto next = static_cast<std::uint32_t>(state.particles.size());
  state.particles.add(next, {0.41, 0.35, 0.2}, {0, 0, 0});  // 0.175 m above the surface, H = 0.1 m
  EXPECT_NEAR(read_one(scene, state), 0.2, 1e-12);
  state.particles.add(next + 1, {0.41, 0.26, 0.2}, {0, 0, 0});  // a bridge to it
  EXPECT_NEAR(read_one(scene, state), 0.375, 1e-12);
}

TEST(LevelGauge, IsZeroOnADryFloorAndTheTopOfADryBox) {
  Scene scene = with_gauge(test::empty_tank(), "level", {0.4, 0.0, 0.2});
  State state;
  state.particles.add(0, {0.4, 0.3, 0.2}, {0, 0, 0});  // falling
  EXPECT_EQ(read_one(scene, state), 0.0);
  scene.boxes.push_back({{0.2, 0.0, 0.0}, {0.6, 0.15, 0.4}, {}});
  EXPECT_NEAR(read_one(scene, state), 0.15, 1e-12);
  state.particles.positions[0].y() = 0.2;  // within H of the box
  EXPECT_NEAR(read_one(scene, state), 0.225, 1e-12);
}

/// A linear field is reproduced at the centre of a symmetric arrangement, whatever the weights.
TEST(VelocityGauge, IsTheWeightedMean) {
  const Scene scene = with_gauge(test::filled_tank(6), "velocity", {0.4, 0.15, 0.2});
  State state = start_of(scene);
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const auto& x = state.particles.positions[i];
    state.particles.velocities[i] = {3.0 * x.x(), -2.0 * x.y(), 1.0};
  }
  const auto values = Gauges(scene, Pressure::wcsph).read(state);
  ASSERT_EQ(values.size(), 3u);
  EXPECT_NEAR(values[0], 1.2, 1e-12);
  EXPECT_NEAR(values[1], -0.3, 1e-12);
  EXPECT_NEAR(values[2], 1.0, 1e-12);
}

TEST(Gauges, HaveNoVelocityAndNoPressureWhereThereIsNoWater) {
  Scene scene = with_gauge(test::filled_tank(2), "velocity", {0.4, 0.5, 0.2});
  scene.gauges.push_back({"p", {0.4, 0.5, 0.2}, "pressure"});
  const Gauges gauges(scene, Pressure::wcsph);
  const auto values = gauges.read(start_of(scene));
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[3], 0.0);
  std::ostringstream text;
  write_gauges_header(text, gauges);
  write_gauges(text, 0.5, values);
  EXPECT_EQ(text.str(), "time_s,g_x,g_y,g_z,p\n0.5,,,,0\n");
}

/// Pressures of dfsph are part of the state: with p/rho0 = k everywhere the wall's force per area is k rho0 times the
/// sum over layers of dx A(d)/H. The integral of A/H over d is 1/2 from the face on, so that the sum is near k rho0/2:
/// as the pressure of the outer layer of a solved state is twice the water's (docs/dfsph.md).
TEST(PressureGauge, OnAWallIsForcePerArea) {
  Scene scene = with_gauge(test::filled_tank(6), "pressure", {0.4, 0.0, 0.2});
  State state = start_of(scene);
  state.particles.pressures.assign(state.particles.size(), 2.0);
  const double floor = read_one(scene, state, Pressure::dfsph);
  EXPECT_GT(floor, 0.3 * 2000.0);
  EXPECT_LT(floor, 0.7 * 2000.0);
  // Twice the pressure, twice the force; the same on a side wall deep in the water and on a box.
  for (double& pressure : state.particles.pressures) pressure *= 2.0;
  EXPECT_NEAR(read_one(scene, state, Pressure::dfsph), 2.0 * floor, 1e-9 * floor);
  scene.gauges[0].position_m = {0.0, 0.15, 0.2};
  EXPECT_NEAR(read_one(scene, state, Pressure::dfsph), 2.0 * floor, 1e-9 * floor);
}

TEST(PressureGauge, InsideIsTheMeanOfThePressures) {
  const Scene scene = with_gauge(test::filled_tank(6), "pressure", {0.4, 0.15, 0.2});
  State state = start_of(scene);
  state.particles.pressures.clear();
  for (const auto& x : state.particles.positions) state.particles.pressures.push_back(9.81 * (0.3 - x.y()));
  EXPECT_NEAR(read_one(scene, state, Pressure::dfsph), 1000 * 9.81 * 0.15, 1e-9);
}

/// wcsph: the force on the whole floor, gauge by gauge, is what the walls give to the water as a whole.
TEST(PressureGauge, OnTheFloorAddsUpToTheForceOfTheWalls) {
  Scene scene = test::filled_tank(4);
  State state = start_of(scene);
  for (auto& x : state.particles.positions) x.y() *= 0.98;  // 2 % too dense: pressure everywhere
  for (int z = 0; z < 4; ++z)
    for (int x = 0; x < 8; ++x)
      scene.gauges.push_back({std::to_string(8 * z + x), {0.05 + 0.1 * x, 0.0, 0.05 + 0.1 * z}, "pressure"});
  const auto values = Gauges(scene, Pressure::wcsph).read(state);
  double force = 0.0;
  for (const double value : values) force += 0.1 * 0.1 * value;
  const WaterField field(scene, Pressure::wcsph);
  double expected = 0.0;
  for (const auto& point : field.around(state, {{0.4, 0.3, 0.2}}, 1.0))
    expected += scene.particle_mass() * point.wall_acceleration.y();
  EXPECT_GT(expected, 0.0);
  EXPECT_NEAR(force, expected, 1e-9 * expected);
}

}  // namespace
}  // namespace squall::harness
