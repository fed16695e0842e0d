#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/scene.h"

namespace {

using Eigen::Vector3d;
using squall::initial_particles;
using squall::InputError;
using squall::particle_capacity;
using squall::Particles;
using squall::Scene;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double k_eps = std::numeric_limits<double>::epsilon();

/// An open container of 2 x 2 x 2 m whose min corner is not the origin.
Scene empty_scene(double spacing) {
  Scene scene;
  scene.time.duration_s = 1.0;
  scene.fluid.spacing_m = spacing;
  scene.container.min_m = {-1.0, -0.5, 3.0};
  scene.container.max_m = {1.0, 1.5, 5.0};
  scene.container.open_top = true;
  return scene;
}

/// A block whose min corner lies at `corner` from the container's.
Scene::Block block_at(const Scene& scene, const Vector3d& corner, const Vector3d& size) {
  Scene::Block block;
  block.min_m = scene.container.min_m + corner;
  block.max_m = block.min_m + size;
  return block;
}

void add_rain(Scene& scene, std::int64_t max_particles) {
  Scene::Rain rain;
  rain.particles_per_s = 100.0;
  rain.area_min_m = {-0.5, 3.5};
  rain.area_max_m = {0.5, 4.5};
  rain.height_m = 1.75;
  rain.max_particles = max_particles;
  scene.rains.push_back(rain);
}

void expect_near(const Vector3d& actual, const Vector3d& expected) {
  // Coordinates up to 5 m; the sum, the product and the two differences round once each.
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], 4 * k_eps * 5.0);
}

// ---- filling ---------------------------------------------------------------------------------------------------

TEST(Fill, StartsHalfASpacingOffTheFacesAndRunsXFirst) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.2, 0.0, 0.4}, {0.3, 0.2, 0.2}));
  scene.blocks[0].velocity_m_s = {1, 2, 3};
  const Particles particles = initial_particles(scene);
  ASSERT_EQ(particles.size(), 3u * 2u * 2u);
  expect_near(particles.positions[0], {0.25, 0.05, 0.45});
  expect_near(particles.positions[1], {0.35, 0.05, 0.45});
  expect_near(particles.positions[2], {0.45, 0.05, 0.45});
  expect_near(particles.positions[3], {0.25, 0.15, 0.45});
  expect_near(particles.positions[6], {0.25, 0.05, 0.55});
  expect_near(particles.positions[11], {0.45, 0.15, 0.55});
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_EQ(particles.ids[i], i);
    EXPECT_EQ(particles.velocities[i], Vector3d(1, 2, 3));
  }
}

TEST(Fill, CountsLayersInSpiteOfRounding) {
  for (int n = 1; n <= 300; ++n) {
    Scene scene = empty_scene(0.4 / n);
    scene.blocks.push_back(block_at(scene, {0.1, 0.1, 0.1}, {0.4, 0.4 / n, 0.4 / n}));
    EXPECT_EQ(initial_particles(scene).size(), static_cast<std::size_t>(n)) << "n = " << n;
  }
}

TEST(Fill, LeavesARestThatIsThinnerThanASpacingEmpty) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.299, 0.1, 0.1}));
  EXPECT_EQ(initial_particles(scene).size(), 2u);
}

TEST(Fill, LeavesOutPointsInsideBoxes) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}));
  EXPECT_EQ(particle_capacity(scene), 125);
  // Holds the points 1..2 of five on every axis: 8 of 125; a second one that overlaps it takes no point twice.
  scene.boxes.push_back(
      {scene.container.min_m + Vector3d(0.1, 0.1, 0.1), scene.container.min_m + Vector3d(0.3, 0.3, 0.3), {}});
  scene.boxes.push_back(
      {scene.container.min_m + Vector3d(0.2, 0.1, 0.1), scene.container.min_m + Vector3d(0.4, 0.2, 0.2), {}});
  const Particles particles = initial_particles(scene);
  EXPECT_EQ(particles.size(), 125u - 8u - 1u);
  EXPECT_EQ(particle_capacity(scene), 125 - 8 - 1);
  std::vector<std::uint32_t> expected_ids(particles.size());
  std::iota(expected_ids.begin(), expected_ids.end(), 0u);
  EXPECT_EQ(particles.ids, expected_ids);
  for (const Vector3d& p : particles.positions)
    EXPECT_FALSE((p.array() > 0.1).all() && (p.array() < 0.3).all()) << p.transpose();
}

TEST(Fill, CountsWithoutFillingWhatItFills) {
  std::mt19937 random(11664);
  std::uniform_real_distribution<double> coordinate(0.0, 1.4);
  for (int repeat = 0; repeat < 50; ++repeat) {
    Scene scene = empty_scene(0.1);
    scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {1.3, 0.7, 1.1}));
    for (int b = 0; b < 5; ++b) {
      const Vector3d one(coordinate(random), coordinate(random), coordinate(random));
      const Vector3d other(coordinate(random), coordinate(random), coordinate(random));
      scene.boxes.push_back(
          {scene.container.min_m + one.cwiseMin(other), scene.container.min_m + one.cwiseMax(other), {}});
    }
    EXPECT_EQ(static_cast<std::size_t>(particle_capacity(scene)), initial_particles(scene).size());
  }
}

TEST(Fill, KeepsABlockThatOnlyTouchesABox) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}));
  scene.boxes.push_back(
      {scene.container.min_m + Vector3d(0.5, 0.0, 0.0), scene.container.min_m + Vector3d(0.7, 1.0, 1.0), {}});
  EXPECT_EQ(initial_particles(scene).size(), 125u);
}

TEST(Fill, GivesIdsInSceneOrder) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {1.0, 0.0, 0.0}, {0.1, 0.1, 0.1}));
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.2, 0.1, 0.1}));
  scene.particle_files.push_back({"a.csv", {}});
  scene.particle_files[0].particles.add(0, scene.container.min_m + Vector3d(0.5, 0.5, 0.5), {7, 8, 9});
  const Particles particles = initial_particles(scene);
  EXPECT_THAT(particles.ids, testing::ElementsAre(0u, 1u, 2u, 3u));
  expect_near(particles.positions[0], {1.05, 0.05, 0.05});
  expect_near(particles.positions[2], {0.15, 0.05, 0.05});
  expect_near(particles.positions[3], {0.5, 0.5, 0.5});
  EXPECT_EQ(particles.velocities[3], Vector3d(7, 8, 9));
}

TEST(Fill, RefusesBlocksThatOverlapButNotOnesThatTouch) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}));
  scene.blocks.push_back(block_at(scene, {0.5, 0.0, 0.0}, {0.5, 0.5, 0.5}));
  EXPECT_EQ(initial_particles(scene).size(), 250u);
  scene.blocks.push_back(block_at(scene, {0.9, 0.4, 0.4}, {0.5, 0.5, 0.5}));
  EXPECT_THAT([&] { initial_particles(scene); },
              ThrowsMessage<InputError>("block 3 overlaps block 2; move them apart"));
}

TEST(Capacity, HasRoomForTheRain) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}));
  add_rain(scene, 1000);
  add_rain(scene, 7);
  EXPECT_EQ(particle_capacity(scene), 125 + 1007);
}

// ---- scaling ---------------------------------------------------------------------------------------------------

TEST(Scale, PicksTheNearestCountOfLayers) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.5, 1.0, 0.5}));  // n layers: 2 n^3
  EXPECT_EQ(scale_to_particles(scene, 2 * 17 * 17 * 17 + 100), 2 * 17 * 17 * 17);
  EXPECT_DOUBLE_EQ(scene.fluid.spacing_m, 0.5 / 17);
  EXPECT_EQ(initial_particles(scene).size(), 2u * 17 * 17 * 17);
  EXPECT_EQ(scale_to_particles(scene, 2 * 17 * 17 * 17 + 1000), 2 * 18 * 18 * 18);
  EXPECT_EQ(scale_to_particles(scene, 1), 2);
  EXPECT_DOUBLE_EQ(scene.fluid.spacing_m, 0.5);
}

TEST(Scale, NoOtherCountOfLayersIsNearer) {
  for (const std::int64_t wanted : {1, 2, 63, 64, 65, 1000, 54321}) {
    Scene scene = empty_scene(0.1);
    scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {0.31, 0.5, 0.47}));
    scene.blocks.push_back(block_at(scene, {0.0, 1.0, 0.0}, {0.9, 0.27, 0.31}));
    add_rain(scene, 123);
    std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
    for (int n = 2; n < 100; ++n) {  // one layer of 0.31 m leaves no room in 0.27 m
      const double spacing = (scene.blocks[0].max_m - scene.blocks[0].min_m).minCoeff() / n;
      const double more = std::pow(0.1 / spacing, 3);
      Scene other = scene;
      other.fluid.spacing_m = spacing;
      other.rains[0].max_particles = std::llround(123 * more);
      nearest = std::min(nearest, std::abs(particle_capacity(other) - wanted));
    }
    const std::int64_t got = scale_to_particles(scene, wanted);
    EXPECT_EQ(got, particle_capacity(scene));
    EXPECT_EQ(std::abs(got - wanted), nearest) << "wanted " << wanted << ", got " << got;
  }
}

TEST(Scale, ToTheCountItHasChangesNothing) {
  Scene scene = squall::load_scene(std::string(SQUALL_SCENES_DIR) + "/drop.toml");
  const std::string hash = scene_hash(scene);
  EXPECT_EQ(scale_to_particles(scene, 11664), 11664);
  EXPECT_EQ(scene_hash(scene), hash);
}

TEST(Scale, KeepsTheMassOfRain) {
  Scene scene = empty_scene(0.1);
  add_rain(scene, 1000);
  Scene::Rain in_mm = scene.rains[0];
  in_mm.particles_per_s.reset();
  in_mm.rate_mm_h = 50.0;
  scene.rains.push_back(in_mm);
  const double kg_per_s = *scene.rains[0].particles_per_s * scene.particle_mass();
  const double kg = static_cast<double>(scene.rains[0].max_particles) * scene.particle_mass();
  EXPECT_EQ(scale_to_particles(scene, 16000), 16000);  // 40 layers instead of 20 on the base's 2 m
  EXPECT_DOUBLE_EQ(scene.fluid.spacing_m, 0.05);
  EXPECT_DOUBLE_EQ(*scene.rains[0].particles_per_s * scene.particle_mass(), kg_per_s);
  EXPECT_DOUBLE_EQ(static_cast<double>(scene.rains[0].max_particles) * scene.particle_mass(), kg);
  EXPECT_EQ(scene.rains[1].rate_mm_h, 50.0);
  EXPECT_EQ(scene.rains[1].max_particles, 8000);
}

TEST(Scale, CountsWhatBoxesTakeAway) {
  Scene scene = empty_scene(0.1);
  scene.blocks.push_back(block_at(scene, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
  scene.boxes.push_back({scene.container.min_m, scene.container.min_m + Vector3d(1.0, 0.5, 1.0), {}});
  EXPECT_EQ(scale_to_particles(scene, 4000), 4000);  // 20^3 less its lower half
  EXPECT_EQ(initial_particles(scene).size(), 4000u);
}

TEST(Scale, RefusesWhatHasNoSpacingToChange) {
  Scene empty = empty_scene(0.1);
  EXPECT_THAT([&] { scale_to_particles(empty, 100); }, ThrowsMessage<InputError>(HasSubstr("neither blocks nor rain")));
  Scene with_file = empty_scene(0.1);
  with_file.particle_files.push_back({"a.csv", {}});
  EXPECT_THAT([&] { scale_to_particles(with_file, 100); }, ThrowsMessage<InputError>(HasSubstr("'a.csv'")));
  Scene with_block = empty_scene(0.1);
  with_block.blocks.push_back(block_at(with_block, {0, 0, 0}, {1, 1, 1}));
  EXPECT_THAT([&] { scale_to_particles(with_block, 0); },
              ThrowsMessage<InputError>(HasSubstr("allowed is 1 to 268435456")));
  EXPECT_THROW(scale_to_particles(with_block, std::int64_t{1} << 40), InputError);
  EXPECT_EQ(with_block.fluid.spacing_m, 0.1);
}

}  // namespace
