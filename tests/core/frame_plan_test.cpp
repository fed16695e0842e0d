// The frame plan: how many sub-steps, how long, and what each is told about gravity, boxes, held blocks and wind.
#include "core/frame_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "backends.h"
#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

Clock clock_at(std::uint64_t frame, int previous_substeps = 0, double previous_dt = 0) {
  Clock clock;
  clock.frame = frame;
  clock.previous_substeps = previous_substeps;
  clock.previous_dt = previous_dt;
  return clock;
}

/// Plans of `frames` frames, each following the one before, at rest.
std::vector<FramePlan> plan_frames(const Scene& scene, int frames, const Settings& settings = {}) {
  std::vector<FramePlan> plans;
  Clock clock = clock_at(0);
  for (int f = 0; f < frames; ++f) {
    plans.push_back(plan_frame(scene, settings, clock));
    clock = clock_at(clock.frame + 1, static_cast<int>(plans.back().substeps.size()), plans.back().dt);
  }
  return plans;
}

// An impact that stops water within a sub-step is no acceleration that goes on for a frame.
TEST(FramePlan, DfsphIsPlannedByGravityNotByImpacts) {
  Settings settings;
  settings.pressure = Pressure::dfsph;
  Clock clock = clock_at(7);
  clock.max_speed = 2;
  const std::size_t calm = plan_frame(filled_tank(4), settings, clock).substeps.size();
  clock.max_acceleration = 2000;
  EXPECT_EQ(plan_frame(filled_tank(4), settings, clock).substeps.size(), calm);
}

TEST(FramePlan, DfsphStartsFromHalfThePressureUnlessWallsVanish) {
  Scene scene = filled_tank(4);
  scene.boxes = {{{0.3, 0.3, 0.1}, {0.35, 0.5, 0.2}, 0.05}};
  Settings settings;
  settings.pressure = Pressure::dfsph;
  int boxes_before = 1, vanished = 0;
  for (const FramePlan& plan : plan_frames(scene, 6, settings))
    for (const auto& substep : plan.substeps) {
      const bool vanishing = substep.box_count < boxes_before;
      vanished += vanishing;
      EXPECT_EQ(substep.warm_kick, vanishing ? 0 : 0.5 * substep.kick);
      EXPECT_NEAR(substep.inverse_kick * substep.kick, 1, rounding<double>(2));
      EXPECT_NEAR(substep.relaxation_rate * substep.dt, 0.5, rounding<double>(2));
      boxes_before = substep.box_count;
    }
  EXPECT_EQ(vanished, 1);
}

TEST(FramePlan, SubstepsFillTheFrameAndObeyTheLimit) {
  const Scene scene = filled_tank(4);
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph})
    for (const double speed : {0.0, 0.7, 4.4}) {
      Settings settings;
      settings.pressure = pressure;
      Clock clock = clock_at(7);
      clock.max_speed = speed;
      clock.max_acceleration = 25;
      const FramePlan plan = plan_frame(scene, settings, clock);
      const double n = static_cast<double>(plan.substeps.size());
      const double acceleration = pressure == Pressure::dfsph ? 9.81 : 25;
      const double limit = time_step_limit(scene, pressure, speed + acceleration / 60);
      EXPECT_EQ(plan.frame, 7u);
      EXPECT_FALSE(plan.limited);
      EXPECT_NEAR(n * plan.dt, 1.0 / 60, rounding<double>(2, 1.0 / 60));
      EXPECT_LE(plan.dt, limit * (1 + 1e-6));
      EXPECT_GT(1.0 / 60 / std::max(n - 1, 1e-9), limit) << "one sub-step fewer would have done";
      for (const auto& substep : plan.substeps) EXPECT_EQ(substep.dt, plan.dt);
    }
}

TEST(FramePlan, GravityCountsAsAnAccelerationFromTheFirstFrameOn) {
  Scene scene = filled_tank(4);
  scene.solver.speed_of_sound_m_s = 1;
  scene.gravity_m_s2 = {0, -981, 0};
  const FramePlan plan = plan_frame(scene, {}, clock_at(0));
  EXPECT_LE(plan.dt, time_step_limit(scene, Pressure::wcsph, 981.0 / 60) * (1 + 1e-6));
}

TEST(FramePlan, CountFallsByATenthAtMostAndRisesFreely) {
  const Scene scene = filled_tank(4);
  const std::size_t calm = plan_frame(scene, {}, clock_at(0)).substeps.size();
  ASSERT_LT(calm, 30u);
  for (const auto& [before, after] : std::vector<std::pair<int, std::size_t>>{{100, 90}, {59, 54}, {40, 36}, {31, 28}})
    EXPECT_EQ(plan_frame(scene, {}, clock_at(1, before, 1e-4)).substeps.size(), std::max(after, calm)) << before;
  Clock fast = clock_at(1, 1, 1.0 / 60);
  fast.max_speed = 50;
  EXPECT_GT(plan_frame(scene, {}, fast).substeps.size(), 4 * calm);
  int count = 100, frames = 0;
  for (; count > static_cast<int>(calm); ++frames) {
    const int next = static_cast<int>(plan_frame(scene, {}, clock_at(1, count, 1e-4)).substeps.size());
    ASSERT_LT(next, count) << "below ten it falls by one";
    ASSERT_GE(next, count - std::max(1, count / 10));
    count = next;
  }
}

TEST(FramePlan, TooManySubstepsAreCutAndSaidSo) {
  for (const double speed : {1e6, std::numeric_limits<double>::infinity()}) {
    Clock clock = clock_at(0);
    clock.max_speed = speed;
    const FramePlan plan = plan_frame(filled_tank(4), {}, clock);
    EXPECT_TRUE(plan.limited);
    EXPECT_EQ(plan.substeps.size(), static_cast<std::size_t>(k_max_substeps));
  }
}

// A fixed step is taken whatever the bounds say, and fills the frame.
TEST(FramePlan, AFixedStepKnowsNoBound) {
  Scene scene = filled_tank(4);
  scene.fluid.viscosity_m2_s = 100;
  Settings settings;
  Clock fast = clock_at(0, 900, 1e-5);
  fast.max_speed = 1e6;
  for (const int count : {1, 7, k_max_substeps}) {
    settings.fixed_step_s = 1.0 / 60 / count;
    const FramePlan plan = plan_frame(scene, settings, fast);
    EXPECT_EQ(plan.substeps.size(), static_cast<std::size_t>(count));
    EXPECT_NEAR(plan.dt, settings.fixed_step_s, rounding<double>(4));
    EXPECT_FALSE(plan.limited);
    EXPECT_NO_THROW(make_solver("reference", scene, settings));
  }
  for (const double nonsense : {-1e-3, 1.0 / 60 / 1100, std::numeric_limits<double>::quiet_NaN()}) {
    settings.fixed_step_s = nonsense;
    EXPECT_THROW(make_solver("reference", filled_tank(4), settings), InputError) << nonsense;
  }
  settings.fixed_step_s = 0;
  EXPECT_THROW(make_solver("reference", scene, settings), InputError) << "100 m^2/s need too many";
}

// Leap-frog: the first kick of all is half a step, any other reaches from middle to middle.
TEST(FramePlan, KicksReachFromMiddleToMiddle) {
  const Scene scene = filled_tank(4);
  const FramePlan first = plan_frame(scene, {}, clock_at(0));
  EXPECT_EQ(first.substeps[0].kick, first.dt / 2);
  EXPECT_EQ(first.substeps[0].previous_dt, 0);
  EXPECT_EQ(first.substeps[1].kick, first.dt);
  const FramePlan next = plan_frame(scene, {}, clock_at(1, 5, 1.0 / 300));
  EXPECT_NEAR(next.substeps[0].kick, (1.0 / 300 + next.dt) / 2, rounding<double>(2, 0.01));
  EXPECT_EQ(next.substeps[0].previous_dt, 1.0 / 300);
}

TEST(FramePlan, GravityAloneWithoutMotion) {
  for (const FramePlan& plan : plan_frames(filled_tank(4), 2))
    for (const auto& substep : plan.substeps) {
      EXPECT_EQ(substep.acceleration_x, 0);
      EXPECT_EQ(substep.acceleration_y, -9.81);
      EXPECT_EQ(substep.acceleration_z, 0);
    }
}

// What the kicks of all frames take away is the velocity that the container gained, to rounding: no impulse is lost,
// however short the motion.
TEST(FramePlan, KicksCarryTheWholeImpulseOfTheContainer) {
  for (const double duration : {0.1, 0.001}) {
    Scene scene = filled_tank(4);
    scene.container.motions.push_back({0.05, duration, std::nullopt, Eigen::Vector3d(0.3 / duration, 0, 0)});
    double gained = 0, time = 0;
    int kicks = 0;
    for (const FramePlan& plan : plan_frames(scene, 12))
      for (const auto& substep : plan.substeps) {
        gained -= substep.kick * substep.acceleration_x;
        ++kicks;
        // velocities now belong to the middle of this sub-step
        EXPECT_NEAR(gained, container_velocity(scene, time + substep.dt / 2).x(),
                    rounding<double>(8 * kicks, 0.3 / duration * time + 1));
        time += substep.dt;
      }
    EXPECT_NEAR(gained, 0.3, rounding<double>(8 * kicks, 1));
  }
}

TEST(FramePlan, BoxesVanishInTheFirstSubstepAtOrAfterTheirTime) {
  Scene scene = filled_tank(4);
  const auto box = [](double x, std::optional<double> until) {
    return Scene::SolidBox{{x, 0.4, 0.1}, {x + 0.05, 0.5, 0.2}, until};
  };
  scene.boxes = {box(0.1, 0.1), box(0.2, std::nullopt), box(0.3, 0.0712), box(0.4, 0.1)};
  double time = 0;
  for (const FramePlan& plan : plan_frames(scene, 8))
    for (const auto& substep : plan.substeps) {
      const double now = time + 1e-9;
      EXPECT_EQ(substep.box_count, 1 + 2 * (now < 0.1) + (now < 0.0712)) << time;
      time += substep.dt;
    }
  // those that stand longest come first, in the scene's order where equal
  const auto boxes = make_boxes(scene, Pressure::wcsph);
  ASSERT_EQ(boxes.size(), 4u);
  const std::vector<double> expected = {0.2, 0.1, 0.4, 0.3};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(boxes[i].solid_min[0], expected[i]);
}

TEST(FramePlan, FacesOfBoxesLieShiftedIntoThem) {
  Scene scene = empty_tank();
  scene.container.min_m = {-1, 0, 0};
  scene.boxes = {{{0.1, 0, 0.1}, {0.3, 0.2, 0.3}, std::nullopt}};
  struct Shapes {
    Pressure pressure;
    int density, force;
  };
  for (const Shapes& shapes :
       {Shapes{Pressure::wcsph, SQUALL_CUBIC, SQUALL_CUBIC}, Shapes{Pressure::mueller, SQUALL_POLY6, SQUALL_SPIKY},
        Shapes{Pressure::dfsph, SQUALL_BELL, SQUALL_BELL}}) {
    const auto box = make_boxes(scene, shapes.pressure).at(0);
    const double density = 0.05 * wall_shift(shapes.density, 2), force = 0.05 * wall_shift(shapes.force, 2);
    const double tolerance = rounding<double>(4, 2);
    EXPECT_NEAR(box.solid_min[0], 1.1, tolerance) << "relative to the container";
    EXPECT_NEAR(box.density_min[0], 1.1 + density, tolerance);
    EXPECT_NEAR(box.density_max[1], 0.2 - density, tolerance);
    EXPECT_NEAR(box.force_min[2], 0.1 + force, tolerance);
    EXPECT_NEAR(box.force_max[0], 1.3 - force, tolerance);
  }
}

TEST(FramePlan, HeldBlocksAreReleasedOnceInTheRightSubstep) {
  Scene scene = empty_tank();
  const auto block = [](double x, std::optional<double> until) {
    Scene::Block made;
    made.min_m = {x, 0.1, 0.1};
    made.max_m = {x + 0.1, 0.2, 0.2};
    made.held_until_s = until;
    return made;
  };
  scene.blocks = {block(0.1, 0.1), block(0.2, std::nullopt), block(0.3, 0.0712), block(0.4, 0.1)};
  double time = 0;
  int released = 0, held_before = 3;
  for (const FramePlan& plan : plan_frames(scene, 8))
    for (const auto& substep : plan.substeps) {
      const double now = time + 1e-9;
      EXPECT_EQ(substep.held_count, 2 * (now < 0.1) + (now < 0.0712)) << time;
      EXPECT_EQ(substep.released_count, held_before - substep.held_count) << time;
      held_before = substep.held_count;
      released += substep.released_count;
      time += substep.dt;
    }
  EXPECT_EQ(released, 3);
  const auto groups = make_held_groups(scene);
  ASSERT_EQ(groups.size(), 3u);
  const std::vector<std::uint32_t> first = {0, 24, 16};  // 2 x 2 x 2 particles a block
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(groups[i].first_id, first[i]);
    EXPECT_EQ(groups[i].end_id, first[i] + 8);
  }
}

TEST(FramePlan, StatisticsBelongToTheLastSubstep) {
  Settings settings;
  for (const bool wanted : {true, false}) {
    settings.statistics = wanted;
    const FramePlan plan = plan_frame(filled_tank(4), settings, clock_at(0));
    ASSERT_GT(plan.substeps.size(), 1u);
    for (std::size_t s = 0; s < plan.substeps.size(); ++s)
      EXPECT_EQ(plan.substeps[s].statistics, wanted && s + 1 == plan.substeps.size());
  }
}

TEST(FramePlan, WindIsRelativeToTheContainer) {
  Scene scene = filled_tank(4);
  scene.rains.push_back(rain_over_tank(100));
  scene.rains.back().wind_m_s = {3, 0, -1};
  scene.container.motions.push_back({0, 1, std::nullopt, Eigen::Vector3d(2, 0, 0)});
  double time = 0;
  for (const FramePlan& plan : plan_frames(scene, 3))
    for (const auto& substep : plan.substeps) {
      EXPECT_NEAR(substep.wind_x, 3 - 2 * time, rounding<double>(64, 3));
      EXPECT_EQ(substep.wind_z, -1);
      time += substep.dt;
    }
}

}  // namespace
}  // namespace squall::test
