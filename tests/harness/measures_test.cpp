#include "harness/measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/scene.h"
#include "harness/fake_solver.h"
#include "params.h"

namespace squall::harness {
namespace {

/// A scene whose second block, ids 64 to 71, is held until 0.5 s.
Scene scene_with_held_block() {
  Scene scene = small_scene();
  Scene::Block block;
  block.min_m = {1.5, 2.5, 3.0};
  block.max_m = {1.7, 2.7, 3.2};
  block.held_until_s = 0.5;
  scene.blocks.push_back(block);
  validate(scene);
  return scene;
}

TEST(Observation, OfTheBlockAtRest) {
  const Scene scene = small_scene();
  const auto particles = initial_particles(scene);
  ASSERT_EQ(particles.size(), 64u);
  const Observation seen = observe(scene, particles, 0.0);
  // 0.4 m wide and high: the last layer's centres lie at 0.35 m. Two roundings of 0.4 m each.
  const double tolerance = 2.0 * std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(seen.front_m, 0.4, tolerance);
  EXPECT_NEAR(seen.front_max_m, 0.4, tolerance);
  EXPECT_NEAR(seen.height_m, 0.4, tolerance);
  EXPECT_NEAR(seen.centre_m.y(), 0.2, 64.0 * tolerance);
  EXPECT_EQ(seen.kinetic_j, 0.0);
  // 64 kg of water with its centre 0.2 m above the floor.
  EXPECT_NEAR(seen.potential_j, 64.0 * 9.81 * 0.2, 64.0 * tolerance * 126.0);
}

TEST(Observation, SprayIsNoSurfaceAndLowLayersMakeTheFront) {
  const Scene scene = small_scene();
  auto particles = initial_particles(scene);
  const auto id = static_cast<std::uint32_t>(particles.size());
  particles.add(id, {0.05, 0.75, 0.05}, Eigen::Vector3d::Zero());      // a drop near x = 0, alone
  particles.add(id + 1, {0.75, 0.65, 0.35}, Eigen::Vector3d::Zero());  // far out, high up
  const Observation seen = observe(scene, particles, 0.0);
  EXPECT_NEAR(seen.height_m, 0.4, 1e-15);
  EXPECT_NEAR(seen.front_m, 0.4, 1e-15);
  EXPECT_NEAR(seen.front_max_m, 0.8, 1e-15);
}

TEST(Observation, LeavesLostParticlesOut) {
  const Scene scene = small_scene();
  auto particles = initial_particles(scene);
  const Observation before = observe(scene, particles, 0.0);
  particles.add(64, Eigen::Vector3d::Constant(static_cast<double>(SQUALL_LOST_COORDINATE)), Eigen::Vector3d::Zero());
  const Observation after = observe(scene, particles, 0.0);
  EXPECT_EQ(before.potential_j, after.potential_j);
  EXPECT_EQ(before.front_max_m, after.front_max_m);
  EXPECT_EQ(before.centre_m, after.centre_m);
}

TEST(Observation, HeldParticlesAreNoFrontUntilTheyAreFreed) {
  const Scene scene = scene_with_held_block();
  const auto particles = initial_particles(scene);
  ASSERT_EQ(particles.size(), 72u);
  EXPECT_NEAR(observe(scene, particles, 0.4).front_max_m, 0.4, 1e-15);
  EXPECT_NEAR(observe(scene, particles, 0.5).front_max_m, 0.7, 1e-15);
}

TEST(Observation, WithoutParticlesLengthsHaveNoValueAndSumsAreZero) {
  const Observation seen = observe(small_scene(), Particles{}, 0.0);
  for (const double length : {seen.front_m, seen.front_max_m, seen.height_m, seen.centre_m.x(), seen.centre_m.z()})
    EXPECT_TRUE(std::isnan(length));
  EXPECT_EQ(seen.kinetic_j, 0.0);
  EXPECT_EQ(seen.potential_j, 0.0);
  Particles high;  // alone, far above the floor, far from x = 0
  high.add(0, {0.75, 0.65, 0.35}, Eigen::Vector3d::Zero());
  const Observation drop = observe(small_scene(), high, 0.0);
  EXPECT_TRUE(std::isnan(drop.front_m));
  EXPECT_TRUE(std::isnan(drop.height_m));
  EXPECT_NEAR(drop.front_max_m, 0.8, 1e-15);
}

TEST(Energy, CountsFromAnId) {
  const Scene scene = small_scene();
  Particles particles;
  particles.add(0, {0.1, 0.5, 0.1}, {2.0, 0.0, 0.0});
  particles.add(1, {0.1, 0.0, 0.1}, {0.0, 4.0, 0.0});
  // One kilogram each.
  EXPECT_NEAR(total_energy(scene, particles, 1), 8.0, 1e-14);
  EXPECT_NEAR(total_energy(scene, particles), 8.0 + 2.0 + 9.81 * 0.5, 1e-14);
}

TEST(Finite, SeesANumberThatIsNone) {
  auto particles = initial_particles(small_scene());
  EXPECT_TRUE(is_finite(particles));
  particles.velocities[3].y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_finite(particles));
}

}  // namespace
}  // namespace squall::harness
