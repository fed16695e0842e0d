// A container 10 km from the origin holds the same water: positions are kept relative to its corner.
#include "core/state_hash.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

/// Everything that has a place in the world, `away` from the origin. All lengths are multiples of 1/64 m, which double
/// precision holds exactly, 10 km away, too: what differs then is the solver's fault and not the scene's.
Scene scene_at(const Eigen::Vector3d& away) {
  Scene scene = empty_tank();
  scene.fluid.spacing_m = 3.0 / 64;
  scene.container.min_m = away;
  scene.container.max_m = away + Eigen::Vector3d(48, 36, 24) / 64;
  scene.container.open_top = true;
  scene.container.motions.push_back({0.02, 0.2, Eigen::Vector3d(-0.05, 0, 0), std::nullopt});
  scene.boxes = {{away + Eigen::Vector3d(27, 0, 0) / 64, away + Eigen::Vector3d(30, 6, 24) / 64, 0.06}};
  Scene::Block water, held;
  water.min_m = away;
  water.max_m = away + Eigen::Vector3d(21, 12, 24) / 64;
  held.min_m = away + Eigen::Vector3d(30, 18, 6) / 64;
  held.max_m = away + Eigen::Vector3d(42, 30, 18) / 64;
  held.held_until_s = 0.05;
  scene.blocks = {water, held};
  Scene::Rain rain = rain_over_tank(300);
  rain.area_min_m = Eigen::Vector2d(6, 6) / 64 + Eigen::Vector2d(away.x(), away.z());
  rain.area_max_m = Eigen::Vector2d(42, 18) / 64 + Eigen::Vector2d(away.x(), away.z());
  rain.height_m = away.y() + 40.0 / 64;
  scene.rains.push_back(rain);
  return scene;
}

/// Each way to write the code in each precision; pressure does not know where the container is.
std::vector<BackendUnderTest> backends() {
  std::vector<BackendUnderTest> all;
  for (const Precision precision : k_precisions)
    for (BackendUnderTest under_test : bitwise_backends(Pressure::wcsph, precision)) {
      under_test.name += std::string("_") + to_string(precision);
      all.push_back(under_test);
    }
  return all;
}

class FarAway : public OnEveryBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, FarAway, testing::ValuesIn(backends()),
                         [](const auto& info) { return info.param.name; });

TEST_P(FarAway, TheSameWaterToTheLastBit) {
  const auto here = make(scene_at(Eigen::Vector3d::Zero())), there = make(scene_at({10000, 0, 10000}));
  for (int frame = 0; frame < 5; ++frame) {
    here->advance();
    there->advance();
    const Particles expected = here->state().particles, found = there->state().particles;
    ASSERT_EQ(first_difference(found, expected), "") << "frame " << frame;
    ASSERT_EQ(state_hash(found, GetParam().settings.precision), state_hash(expected, GetParam().settings.precision));
    const PositionsView view = there->positions(), expected_view = here->positions();
    ASSERT_EQ(view.count, expected_view.count);
    for (std::size_t i = 0; i < view.count; ++i) ASSERT_EQ(view.position(i), expected_view.position(i));
  }
}

}  // namespace
}  // namespace squall::test
