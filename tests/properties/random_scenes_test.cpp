// What must hold of any scene, tried on random ones. What fails is shrunk and printed as a scene file. ctest tries the
// same few every time; RC_PARAMS="seed=7 max_success=300" says otherwise.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "core/checkpoint.h"
#include "core/rain.h"
#include "core/state_hash.h"
#include "grid.h"
#include "properties/recipe.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"
#include "support/numbers.h"

namespace squall::test {
namespace {

/// A way to run a scene: two of omp and two of opencl, whose kernels differ by the width.
BackendUnderTest drawn_backend(int which, Pressure pressure) {
  switch (which) {
    case 0:
      return omp("3_threads", 3, Simd::best, pressure);
    case 1:
      return omp("scalar", 1, Simd::scalar, pressure);
    case 2:
      return opencl("particles", Simd::scalar, pressure);
    default:
      return opencl("float8", Simd::avx2, pressure);
  }
}

BackendUnderTest specification(Pressure pressure) { return reference(Precision::single_precision, pressure); }

/// Particles that there must be after so many frames.
std::size_t added(const Scene& scene, int frames) {
  std::size_t count = initial_particles(scene).size();
  for (const Scene::Rain& rain : scene.rains)
    count += static_cast<std::size_t>(drops_due(scene, rain, static_cast<std::uint64_t>(frames - 1)));
  return count;
}

/// Of those not let go yet.
std::size_t held(const Scene& scene, const FrameReport& report) {
  // The last sub-step of a frame begins dt before its end.
  const double time = static_cast<double>(report.frame + 1) / scene.time.frame_rate_hz - report.dt_s;
  std::size_t count = 0;
  for (const Scene::Block& block : scene.blocks) {
    Scene alone = scene;
    alone.blocks = {block};
    if (block.held_until_s && *block.held_until_s > time + 1e-6 / scene.time.frame_rate_hz)
      count += initial_particles(alone).size();
  }
  return count;
}

void expect_sound(const Scene& scene, const Particles& particles) {
  const Eigen::Vector3d size = scene.container_size();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Eigen::Vector3d& x = particles.positions[i];
    RC_ASSERT(x.allFinite());
    RC_ASSERT(particles.velocities[i].allFinite());
    RC_ASSERT(std::isfinite(particles.pressures[i]));
    if (is_lost(x.x())) continue;
    const double skin = rounding<float>(2, size.maxCoeff());  // of a float beside the plane
    RC_ASSERT((x.array() >= -skin).all());
    RC_ASSERT(x.x() <= size.x() + skin);
    RC_ASSERT(x.z() <= size.z() + skin);
    RC_ASSERT(scene.container.open_top || x.y() <= size.y() + skin);
  }
}

State through_a_file(const Solver& solver, const State& state) {
  Checkpoint checkpoint;
  checkpoint.scene_text = checkpoint_scene_text(solver.scene(), solver.settings().pressure);
  checkpoint.pressure = solver.settings().pressure;
  checkpoint.state = state;
  const Checkpoint read = decode_checkpoint(encode_checkpoint(checkpoint), "run.sqc");
  check_origin(read, solver.scene(), solver.settings(), "run.sqc");
  return read.state;
}

// Every particle that was ever put in is there, once, and is a number; what is neither held nor lost is active, and
// inside.
RC_GTEST_PROP(RandomScenes, KeepTheirParticles, (const Recipe& recipe)) {
  const Scene scene = scene_of(recipe);
  const int which = *number(0, 3);
  const auto solver = drawn_backend(which, recipe.pressure).make(scene);
  for (int frame = 1; frame <= recipe.frames; ++frame) {
    const FrameReport& report = solver->advance();
    const State state = solver->state();
    RC_ASSERT(state.particles.size() == added(scene, frame));
    RC_ASSERT(report.particles == static_cast<std::int64_t>(state.particles.size()));
    RC_ASSERT(std::set<std::uint32_t>(state.particles.ids.begin(), state.particles.ids.end()).size() ==
              state.particles.size());
    RC_ASSERT(report.active + report.lost + static_cast<std::int64_t>(held(scene, report)) == report.particles);
    expect_sound(scene, state.particles);
  }
}

// The reference is the specification: any other way gives its bits.
RC_GTEST_PROP(RandomScenes, AreTheSameOnEveryBackend, (const Recipe& recipe)) {
  const Scene scene = scene_of(recipe);
  const auto expected = specification(recipe.pressure).make(scene);
  const auto one = drawn_backend(*number(0, 1), recipe.pressure).make(scene);
  const auto other = drawn_backend(*number(2, 3), recipe.pressure).make(scene);
  for (int frame = 1; frame <= recipe.frames; ++frame) {
    expected->advance();
    const Particles particles = expected->state().particles;
    for (const auto& solver : {one.get(), other.get()}) {
      solver->advance();
      RC_ASSERT(first_difference(solver->state().particles, particles) == "");
      RC_ASSERT(solver->report().clamps == expected->report().clamps);
      RC_ASSERT(solver->report().substeps == expected->report().substeps);
    }
  }
}

// Saved after any frame and loaded by any backend, it goes on to the same bits.
RC_GTEST_PROP(RandomScenes, SurviveACheckpoint, (const Recipe& recipe)) {
  const Scene scene = scene_of(recipe);
  const auto straight = drawn_backend(*number(0, 3), recipe.pressure).make(scene);
  const auto resumed = drawn_backend(*number(0, 3), recipe.pressure).make(scene);
  const int saved = *number(0, recipe.frames);
  for (int frame = 0; frame < saved; ++frame) straight->advance();
  resumed->restore(through_a_file(*straight, straight->state()));
  for (int frame = 0; frame < 2; ++frame) {
    straight->advance();
    resumed->advance();
  }
  RC_ASSERT(first_difference(resumed->state().particles, straight->state().particles) == "");
}

// Printed and read again it is the same scene.
RC_GTEST_PROP(RandomScenes, SurviveBeingPrinted, (const Recipe& recipe)) {
  const Scene scene = scene_of(recipe);
  const std::string printed = print_scene(scene);
  const Scene again = parse_scene(printed, "random.toml");
  RC_ASSERT(print_scene(again) == printed);
  RC_ASSERT(scene_hash(again) == scene_hash(scene));
  RC_ASSERT(initial_particles(again).positions == initial_particles(scene).positions);
}

}  // namespace
}  // namespace squall::test
