#include "harness/validation/formulas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "support/numbers.h"

namespace squall::harness {
namespace {

Scene tank(double length, double depth, double width, double spacing) {
  Scene scene;
  scene.time.duration_s = 5.0;
  scene.fluid.spacing_m = spacing;
  scene.container.max_m = {length, 3.0 * depth, width};
  scene.container.open_top = true;
  scene.blocks.push_back({{0, 0, 0}, {length, depth, width}, {0, 0, 0}, {}});
  return scene;
}

Curve curve(const Scene& scene, const std::string& formula, const std::string& quantity,
            const std::map<std::string, double>& parameters = {}) {
  return make_curve(formula, {scene, quantity, parameters});
}

Scene::Gauge gauge(const std::string& kind, const Eigen::Vector3d& position) { return {"probe", position, kind}; }

/// Values of the modal sum computed beforehand in another program, printed to five decimals.
TEST(Sloshing, FollowsTheModalSumOfASwayPulse) {
  Scene scene = tank(1.6, 0.2, 0.1, 0.025);
  scene.container.motions.push_back({0.0, 1.0, {}, Eigen::Vector3d(0.5, 0.0, 0.0)});
  const Curve x_cm = curve(scene, "sloshing", "x_cm_m");
  const std::pair<double, double> known[] = {{0.25, -.01259}, {0.5, -.04278}, {1.0, -.10194}, {1.5, -.04602},
                                             {2.0, .08042},   {2.5, .08329},  {3.0, -.04351}, {4.0, -.00381}};
  for (const auto& [time, value] : known) EXPECT_NEAR(x_cm(time) - 0.8, value, test::printed(5) + 1e-5) << time;
  scene.gauges.push_back(gauge("level", {0.0, 0.0, 0.05}));
  const Curve level = curve(scene, "sloshing", "probe");
  // At the wall the sum over modes converges as 1/n^2: forty odd modes leave out less than 0.4 mm.
  const std::pair<double, double> wall[] = {{0.5, .03530}, {1.0, .06783}, {1.5, .02847}, {2.5, -.05371}};
  for (const auto& [time, value] : wall) EXPECT_NEAR(level(time) - 0.2, value, 4e-4) << time;
}

TEST(Sloshing, KnowsNaturalPeriods) {
  const Scene scene = tank(1.6, 0.2, 0.1, 0.025);
  EXPECT_NEAR(curve(scene, "sloshing_period", "x_cm_m")(0.0), 2 * test::k_pi / 2.6829, 1e-4);
  EXPECT_NEAR(curve(scene, "sloshing_period", "x_cm_m", {{"mode", 3.0}})(0.0), 2 * test::k_pi / 6.9123, 1e-4);
}

TEST(DragFall, HasTheClosedForm) {
  Scene scene = tank(1.0, 0.2, 0.2, 0.1);
  const std::map<std::string, double> speed{{"terminal_speed_m_s", 6.49}};
  EXPECT_NEAR(curve(scene, "drag_fall", "vy_cm_m_s", speed)(0.5), -4.1444, 5e-5);
  const double start = 0.1;  // centre of the block
  EXPECT_NEAR(curve(scene, "drag_fall", "y_cm_m", speed)(0.5), start - 1.12469, 5e-6);
}

TEST(Ballistic, StartsFromTheParticlesThereAre) {
  Scene scene = tank(1.0, 0.2, 0.2, 0.1);
  scene.blocks[0].velocity_m_s = {1.0, 2.0, 0.0};
  EXPECT_NEAR(curve(scene, "ballistic", "x_cm_m")(0.5), 0.5 + 0.5, 1e-12);
  EXPECT_NEAR(curve(scene, "ballistic", "y_cm_m")(0.5), 0.1 + 1.0 - 0.5 * 9.81 * 0.25, 1e-12);
  EXPECT_NEAR(curve(scene, "ballistic", "vy_cm_m_s")(0.5), 2.0 - 9.81 * 0.5, 1e-12);
}

TEST(Hydrostatic, CountsFromTheSurfaceAtRest) {
  Scene scene = tank(1.0, 0.2, 0.2, 0.1);
  scene.gauges.push_back(gauge("pressure", {0.5, 0.05, 0.1}));
  EXPECT_NEAR(curve(scene, "hydrostatic", "probe")(0.0), 1000 * 9.81 * 0.15, 1e-9);
  scene.gauges[0].position_m.y() = 0.4;
  EXPECT_EQ(curve(scene, "hydrostatic", "probe")(0.0), 0.0);
  EXPECT_NEAR(curve(scene, "weight", "wall_force_y_n")(0.0), 1000 * 9.81 * 1.0 * 0.2 * 0.2, 1e-9);
}

TEST(RitterFront, GrowsWithTwiceTheWaveSpeed) {
  const Scene scene = tank(0.4, 0.8, 0.4, 0.1);
  EXPECT_NEAR(curve(scene, "ritter_front", "front_m")(1.0), 0.4 + 5.603, 5e-4);
}

class Ellipsoid : public testing::Test {
 protected:
  Ellipsoid() {
    scene_.gravity_m_s2.setZero();
    scene_.gauges.push_back(gauge("pressure", {0.5, 0.1, 0.1}));
  }
  Scene scene_ = tank(1.0, 0.2, 0.2, 0.1);
  const std::map<std::string, double> cylinder_{
      {"semi_axis_x_m", 0.3}, {"semi_axis_y_m", 0.2}, {"rate_x_1_s", -4.0}, {"rate_y_1_s", 4.0}};
};

/// Volume and kinetic energy are integrals of the equations, which the midpoint rule keeps to (rate dt)^2 = 2e-9 a
/// step.
TEST_F(Ellipsoid, KeepsVolumeAndEnergy) {
  const Curve x = curve(scene_, "ellipsoid", "x_rms_m", cylinder_),
              y = curve(scene_, "ellipsoid", "y_rms_m", cylinder_);
  const Curve energy = curve(scene_, "ellipsoid", "kinetic_j", cylinder_);
  EXPECT_NEAR(x(0.0), 0.15, 1e-12);
  for (const double time : {0.05, 0.2, 0.5}) {
    EXPECT_NEAR(x(time) * y(time), 0.15 * 0.1, 1e-8);
    EXPECT_NEAR(energy(time) / energy(0.0), 1.0, 1e-7);
  }
  EXPECT_LT(x(0.2), x(0.0));
}

/// For a circle P = (rate a)^2/2.
TEST_F(Ellipsoid, HasThePressureOfACircleAtItsStart) {
  auto circle = cylinder_;
  circle["semi_axis_y_m"] = 0.3;
  EXPECT_NEAR(curve(scene_, "ellipsoid", "probe", circle)(0.0), 1000 * 0.5 * 16.0 * 0.09, 1e-9);
}

TEST_F(Ellipsoid, SaysWhatIsWrong) {
  const auto message = [&](const std::map<std::string, double>& parameters, const std::string& quantity) {
    try {
      curve(scene_, "ellipsoid", quantity, parameters);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto growing = cylinder_;
  growing["rate_x_1_s"] = 4.0;
  EXPECT_THAT(message(growing, "x_rms_m"), testing::HasSubstr("their sum is 8 1/s"));
  EXPECT_THAT(message(cylinder_, "z_rms_m"), testing::HasSubstr("does not give z_rms_m"));
  EXPECT_THAT(message({{"axis", 1.0}}, "x_rms_m"), testing::HasSubstr("has no parameter 'axis'; it has semi_axis_x_m"));
  scene_.gravity_m_s2.y() = -1.0;
  EXPECT_THAT(message(cylinder_, "x_rms_m"), testing::HasSubstr("without gravity"));
}

TEST(Formula, UnknownOnesAreRefusedWithTheNearest) {
  const Scene scene = tank(1.0, 0.2, 0.2, 0.1);
  try {
    curve(scene, "slosh", "x_cm_m");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'sloshing'"));
  }
}

}  // namespace
}  // namespace squall::harness
