// The bounds of a time step, and what is refused because no allowed number of sub-steps keeps them.
#include "core/time_step.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "backends.h"
#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr Pressure k_all[] = {Pressure::wcsph, Pressure::mueller, Pressure::dfsph};

TEST(TimeStepLimit, IsTheSmallestOfItsTerms) {
  Scene scene = empty_tank();  // H = 0.1 m
  scene.solver.dt_max_s = 1;
  scene.solver.speed_of_sound_m_s = 20;
  scene.solver.stiffness_m2_s2 = 400;
  const double tolerance = rounding<double>(16);
  EXPECT_NEAR(time_step_limit(scene, Pressure::wcsph, 0), 0.4 * 0.1 / 20, tolerance);
  EXPECT_NEAR(time_step_limit(scene, Pressure::wcsph, 5), 0.4 * 0.1 / (20 + 6), tolerance);
  EXPECT_NEAR(time_step_limit(scene, Pressure::mueller, 5), 0.4 * 0.1 / (20 + 6), tolerance);
  scene.fluid.viscosity_m2_s = 10;
  EXPECT_NEAR(time_step_limit(scene, Pressure::mueller, 0), 0.1 * 0.01 / 10, tolerance);
  // The central form of wcsph is stiffer, and artificial viscosity adds 0.1 x 0.05 m x 20 m/s / 10.
  EXPECT_NEAR(time_step_limit(scene, Pressure::wcsph, 0), 0.025 * 0.01 / (10 + 0.01), tolerance);
  scene.fluid.viscosity_m2_s.reset();
  scene.solver.dt_max_s = 1e-3;
  EXPECT_EQ(time_step_limit(scene, Pressure::wcsph, 0), 1e-3);
}

TEST(TimeStepLimit, OfDfsphIsMotionAlone) {
  Scene scene = empty_tank();  // dx = 0.05 m, 1e-3 m^2/s
  scene.solver.dt_max_s = 1;
  const double tolerance = rounding<double>(16);
  EXPECT_NEAR(time_step_limit(scene, Pressure::dfsph, 5), 1.5 * 0.4 * 0.05 / 5, tolerance);
  EXPECT_NEAR(time_step_limit(scene, Pressure::dfsph, 0), 0.03 * 0.01 / 1e-3, tolerance);
  scene.fluid.viscosity_m2_s.reset();
  EXPECT_EQ(time_step_limit(scene, Pressure::dfsph, 0), 1);
}

// Viscosity takes up to 54.1 nu dt/H^2 from a mode per step and smoothing xsph dt/dt_max; together they must stay below
// 2. Either alone has its own bound, and smoothing, at most 1, needs none.
TEST(TimeStepLimit, ViscosityAndSmoothingShareIt) {
  Scene scene = empty_tank();
  scene.solver.xsph = 1;
  for (const double viscosity : {0.01, 0.06, 1.0}) {
    scene.fluid.viscosity_m2_s = viscosity;
    const double dt = time_step_limit(scene, Pressure::dfsph, 0);
    const double worst = 54.1 * viscosity * dt / 0.01 + dt / scene.solver.dt_max_s;
    EXPECT_LT(worst, 1.8) << viscosity;
    EXPECT_TRUE(worst > 1.6 || dt == scene.solver.dt_max_s) << "no shorter than it must be: " << viscosity;
  }
  scene.fluid.viscosity_m2_s.reset();
  EXPECT_EQ(time_step_limit(scene, Pressure::dfsph, 0), scene.solver.dt_max_s);
}

// The bound above at work, in the middle of a block that is large enough for the worst mode: each mode shrinks in every
// step, so nobody becomes faster than the fastest of the start. With viscosity's bound alone the mode that alternates
// along an axis grows, to some sixty times that speed in the frame's 56 steps.
TEST(TimeStepLimit, ViscosityAndSmoothingTogetherCalmWater) {
  Scene scene = empty_tank();
  scene.container.max_m = {1, 1, 1};
  scene.gravity_m_s2.setZero();
  scene.fluid.viscosity_m2_s = 1;
  scene.solver.xsph = 1;
  scene.solver.dt_max_s = 0.03 * 0.01 / 1;
  Scene::Block block;
  block.min_m = {0.25, 0.25, 0.25};
  block.max_m = {0.75, 0.75, 0.75};
  scene.blocks.push_back(block);
  Particles particles = initial_particles(scene);
  std::mt19937 random(17);
  std::uniform_real_distribution<double> speed(-1e-3, 1e-3);
  double fastest = 0;
  for (auto& velocity : particles.velocities) {
    velocity = {speed(random), speed(random), speed(random)};
    fastest = std::max(fastest, velocity.norm());
  }
  Settings settings;
  settings.precision = Precision::double_precision;
  const auto solver = make_solver("reference", scene, settings);
  solver->load(particles);
  EXPECT_LE(solver->advance().max_speed, fastest);
}

/// A value that asks for ever shorter steps as it grows.
struct Growing {
  const char* name;  ///< as the message calls it
  std::vector<Pressure> solvers;
  std::function<void(Scene&, double)> set;
  std::function<double(const Scene&, Pressure)> most;  ///< of it, for 1000 sub-steps
  const char* of_another;                              ///< what other solvers have and the message must not name
};

double allowed_viscosity(const Scene& scene, Pressure pressure) {
  const double support = scene.support_radius(), shortest = 1.0 / 60 / k_max_substeps;
  const double factor = pressure == Pressure::mueller ? 0.1 : pressure == Pressure::wcsph ? 0.025 : 0.03;
  const double artificial = pressure == Pressure::wcsph ? 0.1 * support / 2 * scene.speed_of_sound() / 10 : 0.0;
  return factor * support * support / shortest - artificial;
}

double allowed_speed(const Scene& scene, Pressure pressure) {
  const double per_step = 0.4 * 60 * k_max_substeps;  // cfl over the shortest step
  if (pressure == Pressure::dfsph) return 1.5 * per_step * scene.fluid.spacing_m;
  const double signal = pressure == Pressure::wcsph ? scene.speed_of_sound() : 20.0;
  return (per_step * scene.support_radius() - signal) / 1.2;
}

double allowed_signal(const Scene& scene, Pressure) { return 0.4 * 60 * k_max_substeps * scene.support_radius(); }

const std::vector<Growing> k_growing = {
    {"viscosity_m2_s = ",
     {std::begin(k_all), std::end(k_all)},
     [](Scene& scene, double value) { scene.fluid.viscosity_m2_s = value; },
     allowed_viscosity,
     "speed"},
    {"speed_of_sound_m_s = ",
     {Pressure::wcsph},
     [](Scene& scene, double value) { scene.solver.speed_of_sound_m_s = value; },
     allowed_signal,
     "stiffness"},
    {"stiffness_m2_s2 = ",
     {Pressure::mueller},
     [](Scene& scene, double value) { scene.solver.stiffness_m2_s2 = value; },
     [](const Scene& scene, Pressure) { return std::pow(allowed_signal(scene, Pressure::mueller), 2); },
     "sound"},
    {"a start at a speed of ",
     {std::begin(k_all), std::end(k_all)},
     [](Scene& scene, double value) {
       scene.blocks[0].velocity_m_s = {0, -value, 0};
     },
     allowed_speed,
     "viscosity"},
    {"rain with a speed of ",
     {std::begin(k_all), std::end(k_all)},
     [](Scene& scene, double value) {
       scene.rains.push_back(rain_over_tank(100));
       scene.rains[0].wind_m_s = {value, 9.65 - 10.3 * std::exp(-0.6 * 3.0), 0};  // holds the drops' fall up
     },
     allowed_speed,
     "viscosity"},
    {"artificial_viscosity = ",
     {Pressure::wcsph},
     [](Scene& scene, double value) { scene.solver.artificial_viscosity = value; },
     [](const Scene& scene, Pressure) {
       const double support = scene.support_radius();
       return 0.025 * support * support * 60 * k_max_substeps / (0.05 * support * scene.speed_of_sound());
     },
     "stiffness"},
};

TEST(StepProblem, IsSaidOfEveryValueThatIsKnownBeforehand) {
  for (const Growing& growing : k_growing)
    for (const Pressure pressure : growing.solvers) {
      Scene scene = filled_tank(4);
      scene.fluid.spacing_m = 0.04;
      scene.fluid.viscosity_m2_s.reset();
      const double most = growing.most(scene, pressure);
      Scene fine = scene;
      growing.set(fine, most * (1 - 1e-6));
      EXPECT_EQ(step_problem(fine, pressure), "") << growing.name;
      growing.set(scene, most * 1.5);
      const std::string problem = step_problem(scene, pressure);
      const std::string who = to_string(pressure) + std::string(", ") + growing.name;
      EXPECT_THAT(problem, StartsWith(growing.name)) << who;
      EXPECT_THAT(problem, HasSubstr("allowed are 1000")) << who;
      EXPECT_THAT(problem, HasSubstr("spacing_m = 0.04")) << who;
      EXPECT_THAT(problem, HasSubstr("frame_rate_hz")) << who;
      EXPECT_THAT(problem, Not(HasSubstr(growing.of_another))) << who;
      if (pressure == Pressure::dfsph) {
        EXPECT_THAT(problem, Not(HasSubstr("sound"))) << who;
      }
      // What it says is allowed is, and is the most that is, to four digits.
      const auto up_to = problem.find("up to ");
      ASSERT_NE(up_to, std::string::npos) << who;
      const double said = std::stod(problem.substr(up_to + 6));
      EXPECT_LE(said, most * (1 + 1e-9)) << who;
      EXPECT_GE(said, most * (1 - 1e-3)) << who;
    }
}

TEST(StepProblem, ASpeedOfSoundThatNobodySetIsExplained) {
  Scene scene = filled_tank(4);
  scene.gravity_m_s2 = {0, -1000, 0};
  scene.container.max_m = {1e4, 1e4, 1e4};
  scene.blocks[0].max_m = scene.container.max_m;
  scene.fluid.spacing_m = 1;
  EXPECT_EQ(step_problem(scene, Pressure::dfsph), "");
  scene.time.frame_rate_hz = 0.5;
  EXPECT_THAT(step_problem(scene, Pressure::wcsph), HasSubstr("set speed_of_sound_m_s"));
}

// A small Courant number is somebody's caution; only then is raising it a cure.
TEST(StepProblem, RaisingCflIsAdvisedWhereItIsSafe) {
  Scene scene = filled_tank(4);
  scene.solver.speed_of_sound_m_s = 1e4;
  EXPECT_THAT(step_problem(scene, Pressure::wcsph), Not(HasSubstr("raise spacing_m, cfl")));
  scene.solver.cfl = 0.01;
  EXPECT_THAT(step_problem(scene, Pressure::wcsph), HasSubstr("raise spacing_m, cfl or frame_rate_hz"));
}

// Gravity may bring water to a speed or not: that is judged when it has.
TEST(StepProblem, GravityAndContainersAreNotBlamedBeforehand) {
  Scene scene = filled_tank(4);
  scene.solver.speed_of_sound_m_s = 1;
  scene.time.frame_rate_hz = 1;
  scene.gravity_m_s2 = {0, -900, 0};
  scene.container.motions.push_back({0, 1, std::nullopt, Eigen::Vector3d(900, 0, 0)});
  for (const Pressure pressure : k_all) {
    EXPECT_EQ(step_problem(scene, pressure), "");
    EXPECT_THAT(step_problem(scene, pressure, 1e4, "water with a speed"), StartsWith("water with a speed of 1e+04"));
  }
}

// What does not move in a scene's duration is not to blame.
TEST(StepProblem, WhatNeverMovesIsNotBlamed) {
  Scene scene = filled_tank(4);
  scene.time.duration_s = 1.0;
  scene.blocks[0].velocity_m_s = {1e5, 0, 0};
  EXPECT_THAT(step_problem(scene, Pressure::dfsph), StartsWith("a start at a speed of 1e+05 m/s"));
  scene.blocks[0].held_until_s = 2.0;
  EXPECT_EQ(step_problem(scene, Pressure::dfsph), "");
  scene.blocks[0].held_until_s = 0.5;
  EXPECT_THAT(step_problem(scene, Pressure::dfsph), StartsWith("a start at a speed"));

  scene.blocks.clear();
  scene.rains.push_back(rain_over_tank(10));
  scene.rains[0].wind_m_s = {1e5, 0, 0};
  EXPECT_THAT(step_problem(scene, Pressure::dfsph), StartsWith("rain with a speed of 1e+05 m/s"));
  scene.rains[0].start_s = 1.0;
  EXPECT_EQ(step_problem(scene, Pressure::dfsph), "");
  scene.rains[0].start_s = 0.0;
  scene.rains[0].particles_per_s = 0.0;
  EXPECT_EQ(step_problem(scene, Pressure::dfsph), "");
}

TEST(StepProblem, NamesWhatSharesTheBoundOfViscosity) {
  Scene scene = filled_tank(4);
  scene.fluid.viscosity_m2_s = 1.0;
  scene.solver.dt_max_s = 1e-9;
  scene.solver.xsph = 1.0;
  EXPECT_THAT(step_problem(scene, Pressure::dfsph),
              AllOf(StartsWith("viscosity_m2_s = 1 beside xsph = 1 at dt_max_s = 1e-09, which counts as"),
                    HasSubstr("lower viscosity_m2_s or xsph, raise dt_max_s")));
  scene.solver.dt_max_s = 1.0;
  scene.solver.artificial_viscosity = 1e6;
  EXPECT_THAT(step_problem(scene, Pressure::wcsph),
              StartsWith("artificial_viscosity = 1e+06 beside viscosity_m2_s = 1 needs"));
}

}  // namespace
}  // namespace squall::test
