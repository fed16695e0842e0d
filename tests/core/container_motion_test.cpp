// The container's motion in closed form: minimum jerk, constant acceleration, and that one is the other's derivative.
#include <gtest/gtest.h>

#include "core/frame_plan.h"
#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

Scene moved_by(const Eigen::Vector3d& displacement, double start, double duration) {
  Scene scene = empty_tank();
  scene.container.motions.push_back({start, duration, displacement, std::nullopt});
  return scene;
}

Scene pushed_by(const Eigen::Vector3d& acceleration, double start, double duration) {
  Scene scene = empty_tank();
  scene.container.motions.push_back({start, duration, std::nullopt, acceleration});
  return scene;
}

TEST(ContainerMotion, NeverMovesWithoutOne) {
  EXPECT_EQ(container_displacement(empty_tank(), 3), Eigen::Vector3d::Zero());
  EXPECT_EQ(container_velocity(empty_tank(), 3), Eigen::Vector3d::Zero());
}

// x = A (10 s^3 - 15 s^4 + 6 s^5): half way at half time, peak speed 1.875 A/T there.
TEST(ContainerMotion, MinimumJerkGoesFromRestToRest) {
  const double amplitude = -0.4, start = 3, duration = 0.8;
  const Scene scene = moved_by({amplitude, 0, 0.1}, start, duration);
  for (const double before : {0.0, 2.0, 3.0}) {
    EXPECT_EQ(container_displacement(scene, before), Eigen::Vector3d::Zero());
    EXPECT_EQ(container_velocity(scene, before), Eigen::Vector3d::Zero());
  }
  for (const double after : {3.8, 4.0, 100.0}) {
    EXPECT_NEAR(container_displacement(scene, after).x(), amplitude, rounding<double>(64, amplitude));
    EXPECT_NEAR(container_velocity(scene, after).x(), 0, rounding<double>(64, 30 * amplitude / duration));
  }
  const double half = start + duration / 2;
  EXPECT_NEAR(container_displacement(scene, half).x(), amplitude / 2, rounding<double>(64, 4 * amplitude));
  EXPECT_NEAR(container_displacement(scene, half).z(), 0.05, rounding<double>(64, 1));
  EXPECT_NEAR(container_velocity(scene, half).x(), 1.875 * amplitude / duration, rounding<double>(256, 1));
  EXPECT_EQ(container_velocity(scene, half).y(), 0);
}

// Peak acceleration 5.774 A/T^2 (10/sqrt 3) at s = 0.2113 (1/2 - sqrt 3/6); central differences, error h^2/6 max|v'''|.
TEST(ContainerMotion, MinimumJerkPeaksWhereItShould) {
  const double amplitude = 0.4, duration = 0.8, step = 1e-5;
  const Scene scene = moved_by({amplitude, 0, 0}, 0, duration);
  const double at = (0.5 - std::sqrt(3.0) / 6) * duration;
  auto acceleration = [&](double t) {
    return (container_velocity(scene, t + step).x() - container_velocity(scene, t - step).x()) / (2 * step);
  };
  const double tolerance = step * step / 6 * 360 * amplitude / std::pow(duration, 4) + rounding<double>(64, 1) / step;
  EXPECT_NEAR(acceleration(at), 10 / std::sqrt(3.0) * amplitude / (duration * duration), tolerance);
  EXPECT_NEAR(acceleration(duration - at), -10 / std::sqrt(3.0) * amplitude / (duration * duration), tolerance);
}

TEST(ContainerMotion, ConstantAccelerationThenCoasts) {
  const Scene scene = pushed_by({0.5, 0, -2}, 1, 2);
  EXPECT_EQ(container_displacement(scene, 1), Eigen::Vector3d::Zero());
  for (const double t : {0.25, 1.0, 2.0}) {
    EXPECT_NEAR(container_velocity(scene, 1 + t).x(), 0.5 * t, rounding<double>(4));
    EXPECT_NEAR(container_displacement(scene, 1 + t).z(), -t * t, rounding<double>(8, 4));
  }
  EXPECT_NEAR(container_velocity(scene, 10).x(), 1, rounding<double>(4));
  EXPECT_NEAR(container_displacement(scene, 10).x(), 1 + 7, rounding<double>(8, 8));
}

TEST(ContainerMotion, SeveralAddUp) {
  Scene both = moved_by({0.3, 0, 0}, 0.5, 1);
  both.container.motions.push_back({0.75, 0.5, std::nullopt, Eigen::Vector3d(0, 1, 0)});
  const Scene first = moved_by({0.3, 0, 0}, 0.5, 1), second = pushed_by({0, 1, 0}, 0.75, 0.5);
  for (const double t : {0.6, 0.9, 1.4, 3.0}) {
    EXPECT_EQ(container_displacement(both, t), container_displacement(first, t) + container_displacement(second, t));
    EXPECT_EQ(container_velocity(both, t), container_velocity(first, t) + container_velocity(second, t));
  }
}

// Central differences of the displacement: h^2/6 max|x'''| with |x'''| <= 60 A/T^3, and jumps of acceleration times h.
TEST(ContainerMotion, VelocityIsTheDerivativeOfDisplacement) {
  const double step = 1e-5;
  const Scene smooth = moved_by({0.4, -0.2, 0.1}, 0.5, 0.8), abrupt = pushed_by({0.5, 0, -2}, 0.5, 0.8);
  for (int i = 0; i <= 200; ++i) {
    const double t = i * 0.01;
    SCOPED_TRACE(t);
    for (const Scene* scene : {&smooth, &abrupt}) {
      const Eigen::Vector3d difference =
          (container_displacement(*scene, t + step) - container_displacement(*scene, t - step)) / (2 * step);
      const double tolerance = step * step * 60 * 0.4 / 0.5 + 2 * step / 2 + rounding<double>(64, 2) / step;
      EXPECT_LE((container_velocity(*scene, t) - difference).norm(), tolerance);
    }
  }
}

}  // namespace
}  // namespace squall::test
