// Saved and loaded, on every backend: load then run equals run.
#include "core/checkpoint.h"

#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

/// A tank that has everything: water, a box that vanishes, a held block, motion and rain.
Scene busy_tank() {
  Scene scene = filled_tank(3);
  scene.container.open_top = true;
  scene.blocks[0].max_m.x() = 0.3;
  scene.boxes = {{{0.4, 0, 0}, {0.45, 0.1, 0.4}, 0.06}};
  Scene::Block held;
  held.min_m = {0.5, 0.3, 0.1};
  held.max_m = {0.7, 0.5, 0.3};
  held.held_until_s = 0.05;
  scene.blocks.push_back(held);
  scene.container.motions.push_back({0.02, 0.2, Eigen::Vector3d(-0.05, 0, 0), std::nullopt});
  scene.rains.push_back(rain_over_tank(300));
  return scene;
}

/// What a file would bring back.
State through_a_file(const Solver& solver, State state) {
  Checkpoint checkpoint;
  checkpoint.scene_text = checkpoint_scene_text(solver.scene(), solver.settings().pressure);
  checkpoint.pressure = solver.settings().pressure;
  checkpoint.precision = solver.settings().precision;
  checkpoint.state = std::move(state);
  const std::string bytes = encode_checkpoint(checkpoint);
  EXPECT_LE(bytes.size(), largest_checkpoint(solver.scene(), solver.settings().pressure,
                                             solver.settings().precision == Precision::single_precision ? 4 : 8))
      << "what is claimed on disk is enough";
  const Checkpoint read = decode_checkpoint(bytes, "run.sqc");
  check_origin(read, solver.scene(), solver.settings(), "run.sqc");
  return read.state;
}

class CheckpointOf : public OnEveryBackend {};
SQUALL_ON_EVERY_BACKEND(CheckpointOf);

// Saved after every frame: before and after a block is let go (0.05 s), a wall vanishes (0.06 s), while the container
// moves and it rains. Loaded by a solver that was elsewhere.
TEST_P(CheckpointOf, LoadThenRunEqualsRun) {
  const Scene scene = busy_tank();
  const auto straight = make(scene), resumed = make(scene);
  for (int frame = 0; frame < 2; ++frame) resumed->advance();
  for (int frame = 0; frame < 7; ++frame) {
    resumed->restore(through_a_file(*straight, straight->state()));
    straight->advance();
    resumed->advance();
    ASSERT_EQ(first_difference(resumed->state().particles, straight->state().particles), "") << "frame " << frame;
    ASSERT_EQ(through_a_file(*resumed, resumed->state()).clock.max_speed, straight->clock().max_speed);
  }
}

// Every frame on another backend, by way of a file: the bits of one that runs alone.
TEST(Checkpoints, GoFromBackendToBackend) {
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph})
    for (const Precision precision : k_precisions) {
      const Scene scene = busy_tank();
      const std::vector<BackendUnderTest> backends = bitwise_backends(pressure, precision);
      const auto alone = backends[0].make(scene);
      State carried = alone->state();
      for (const BackendUnderTest& backend : backends) {
        SCOPED_TRACE(testing::Message() << backend.name << ", " << to_string(pressure) << ", " << to_string(precision));
        alone->advance();
        const auto solver = backend.make(scene);
        solver->restore(carried);
        solver->advance();
        carried = through_a_file(*solver, solver->state());
        ASSERT_EQ(first_difference(carried.particles, alone->state().particles), "");
      }
    }
}

}  // namespace
}  // namespace squall::test
