// Rain: drops are counted in integers and are a pure function of seed and number.
#include "core/rain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

Scene rainy(const Scene::Rain& rain) {
  Scene scene = empty_tank();
  scene.rains.push_back(rain);
  return scene;
}

Clock start(const Scene& scene) {
  Clock clock;
  clock.rained.assign(scene.rains.size(), 0);
  return clock;
}

/// All drops of the first `frames` frames, as a solver would ask for them.
Particles all_drops(const Scene& scene, std::uint64_t seed, int frames) {
  Particles drops;
  Clock clock = start(scene);
  for (; clock.frame < static_cast<std::uint64_t>(frames); ++clock.frame) {
    const Particles now = release_drops(scene, seed, clock);
    for (std::size_t i = 0; i < now.size(); ++i) drops.add(now.ids[i], now.positions[i], now.velocities[i]);
  }
  return drops;
}

TEST(TerminalSpeed, FollowsAtlasAndTheMeasurements) {
  for (const double diameter : {0.5, 1.0, 3.0, 8.0})
    EXPECT_NEAR(terminal_speed(diameter), 9.65 - 10.3 * std::exp(-0.6 * diameter), rounding<double>(4, 10));
  // Gunn & Kinzer 1949; the fit is within 2.0 % of their table
  const std::vector<std::pair<double, double>> measured = {{0.5, 2.06}, {1.0, 4.03}, {2.0, 6.49}, {3.0, 8.06},
                                                           {4.0, 8.83}, {5.0, 9.09}, {5.8, 9.17}};
  for (const auto& [diameter, speed] : measured)
    EXPECT_NEAR(terminal_speed(diameter), speed, 0.021 * speed) << diameter;
}

TEST(Rain, DropsAreCountedInIntegers) {
  for (const auto& [rate, hertz] :
       std::vector<std::pair<std::int64_t, std::int64_t>>{{200, 60}, {7, 60}, {60, 60}, {1, 50}, {3600, 60}}) {
    Scene scene = rainy(rain_over_tank(static_cast<double>(rate)));
    scene.time.frame_rate_hz = static_cast<double>(hertz);
    scene.rains[0].max_particles = 1 << 30;
    for (const std::int64_t frame : {0, 1, 2, 3, 17, 59, 60, 61, 1199, 1200, 1000000})
      EXPECT_EQ(drops_due(scene, scene.rains[0], static_cast<std::uint64_t>(frame)), rate * frame / hertz)
          << rate << "/s at " << hertz << " Hz, frame " << frame;
  }
}

TEST(Rain, StartsStopsAndEnds) {
  Scene scene = rainy(rain_over_tank(120));
  Scene::Rain& rain = scene.rains[0];
  rain.start_s = 0.5;
  rain.stop_s = 1.0;
  EXPECT_EQ(drops_due(scene, rain, 30), 0);
  EXPECT_EQ(drops_due(scene, rain, 31), 2);
  EXPECT_EQ(drops_due(scene, rain, 60), 60);
  EXPECT_EQ(drops_due(scene, rain, 600), 60);
  rain.max_particles = 25;
  EXPECT_EQ(drops_due(scene, rain, 45), 25);
}

// 100 mm/h over 0.12 m^2 are 12 litres per hour.
TEST(Rain, MillimetresPerHourAreMassPerSecond) {
  Scene scene = rainy(rain_over_tank(1));
  scene.rains[0].particles_per_s.reset();
  scene.rains[0].rate_mm_h = 100;
  const double mass_per_s = particles_per_second(scene, scene.rains[0]) * scene.particle_mass();
  EXPECT_NEAR(mass_per_s, 12.0 / 3600, rounding<double>(16, 12.0 / 3600));
}

TEST(Rain, IsAPureFunctionOfSeedAndNumber) {
  const Scene scene = rainy(rain_over_tank(777));
  const Particles drops = all_drops(scene, 5, 20);
  ASSERT_EQ(drops.size(), 246u);  // floor(777 * 19 / 60): frame 19 is the last
  // the same when asked only once, late
  Clock late = start(scene);
  late.frame = 19;
  const Particles at_once = release_drops(scene, 5, late);
  ASSERT_EQ(at_once.size(), drops.size());
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    EXPECT_EQ(at_once.ids[i], i);
    EXPECT_EQ(at_once.positions[i], drops.positions[i]);
  }
  const Particles other_seed = all_drops(scene, 6, 20);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < drops.size(); ++i) equal += drops.positions[i].x() == other_seed.positions[i].x();
  EXPECT_EQ(equal, 0u);
}

TEST(Rain, ContinuesFromAClock) {
  const Scene scene = rainy(rain_over_tank(200));
  Clock clock = start(scene);
  clock.frame = 6;
  clock.next_id = 42;
  EXPECT_EQ(release_drops(scene, 1, clock).ids, (std::vector<std::uint32_t>{42, 43, 44, 45, 46, 47, 48, 49, 50, 51,
                                                                            52, 53, 54, 55, 56, 57, 58, 59, 60, 61}));
  EXPECT_EQ(clock.rained, (std::vector<std::int64_t>{20}));
  EXPECT_EQ(release_drops(scene, 1, clock).size(), 0u) << "each drop falls once";
  clock.frame = 7;
  EXPECT_EQ(release_drops(scene, 1, clock).ids, (std::vector<std::uint32_t>{62, 63, 64}));
}

TEST(Rain, DropsStartOverTheAreaAndAboveTheContainer) {
  Scene scene = rainy(rain_over_tank(3000));
  scene.container.min_m = {-0.5, 0.1, 0};
  scene.container.max_m = {0.8, 0.6, 0.4};
  const double fall = terminal_speed(scene.rains[0].drop_diameter_mm) / 60;
  const Particles drops = all_drops(scene, 9, 20);
  ASSERT_EQ(drops.size(), 950u);
  Eigen::Array<int, 4, 4> counts = Eigen::Array<int, 4, 4>::Zero();
  for (const Eigen::Vector3d& relative : drops.positions) {
    const Eigen::Vector3d x = relative + scene.container.min_m;
    ASSERT_GE(x.x(), 0.1 - 1e-12);
    ASSERT_LE(x.x(), 0.7 + 1e-12);
    ASSERT_GE(x.z(), 0.1 - 1e-12);
    ASSERT_LE(x.z(), 0.3 + 1e-12);
    ASSERT_GT(x.y(), 0.65);
    ASSERT_LE(x.y(), 0.65 + fall + 1e-12);
    counts(std::min(3, static_cast<int>((x.x() - 0.1) / 0.15)), std::min(3, static_cast<int>((x.z() - 0.1) / 0.05)))++;
  }
  // 950 drops on 16 fields: 59.4 each; five standard deviations are 37
  EXPECT_GT(counts.minCoeff(), 22);
  EXPECT_LT(counts.maxCoeff(), 97);
}

// Drops of one frame are as far apart as they would be had each been released when it was due.
TEST(Rain, ReleasePointsAreSpreadAlongOneFramesFall) {
  const Scene scene = rainy(rain_over_tank(600));  // ten a frame
  const double fall = terminal_speed(3) / 60;
  Clock clock = start(scene);
  clock.frame = 1;
  const Particles drops = release_drops(scene, 1, clock);
  ASSERT_EQ(drops.size(), 10u);
  std::set<double> heights;
  for (const auto& position : drops.positions) heights.insert(position.y() - 0.65);
  double expected = fall / 10;
  for (const double height : heights) {
    EXPECT_NEAR(height, expected, rounding<double>(16, 1));
    expected += fall / 10;
  }
}

TEST(Rain, DropsFallAtTerminalSpeedWithTheWind) {
  Scene scene = rainy(rain_over_tank(600));
  scene.rains[0].wind_m_s = {2, 0, -1};
  Clock clock = start(scene);
  clock.frame = 1;
  const Eigen::Vector3d expected{2, -terminal_speed(3), -1};
  for (const auto& velocity : release_drops(scene, 1, clock).velocities)
    EXPECT_LE((velocity - expected).norm(), rounding<double>(4, 10));
  // in the frame of a container on the move
  scene.container.motions.push_back({0, 10, std::nullopt, Eigen::Vector3d(3, 0, 0)});
  clock = start(scene);
  clock.frame = 60;
  for (const auto& velocity : release_drops(scene, 1, clock).velocities)
    EXPECT_LE((velocity + Eigen::Vector3d(3, 0, 0) - expected).norm(), rounding<double>(8, 10));
}

TEST(Rain, SeveralRainsAreIndependent) {
  Scene scene = rainy(rain_over_tank(60));
  scene.rains.push_back(rain_over_tank(120));
  Clock clock = start(scene);
  clock.frame = 5;
  const Particles drops = release_drops(scene, 1, clock);
  EXPECT_EQ(clock.rained, (std::vector<std::int64_t>{5, 10}));
  std::set<double> places;
  for (const auto& position : drops.positions) places.insert(position.x());
  EXPECT_EQ(places.size(), 15u);
}

}  // namespace
}  // namespace squall::test
