#include <gtest/gtest.h>

#include <cmath>

#include "backend_opencl/opencl_backend.h"

namespace squall::opencl {
namespace {

constexpr int k_frames = 4;

Scene tiny_scene() { return load_scene(SQUALL_TEST_SCENES_DIR "/tiny.toml"); }

std::unique_ptr<Solver> tiny_solver(Readback readback, Settings settings = {}) {
  settings.readback = readback;
  auto solver = opencl::make_solver(tiny_scene(), settings);
  solver->load(initial_particles(solver->scene()));
  return solver;
}

std::vector<float> gather(const PositionsView& view) {
  std::vector<float> positions;
  for (std::size_t i = 0; i < view.count; ++i)
    positions.insert(positions.end(), view.data + i * view.stride, view.data + i * view.stride + 3);
  return positions;
}

std::vector<float> gather(const Particles& particles) {
  std::vector<float> positions;
  for (const auto& x : particles.positions)
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(x[axis]));
  return positions;
}

class ReadbackModes : public testing::TestWithParam<Readback> {};

TEST_P(ReadbackModes, DeliversTheStateAfterEveryFrame) {
  const auto solver = tiny_solver(GetParam());
  for (int frame = 0; frame < k_frames; ++frame) {
    const auto report = solver->advance();
    const auto delivered = gather(solver->positions());
    EXPECT_EQ(delivered.size(), 3 * static_cast<std::size_t>(report.particles));
    EXPECT_EQ(delivered, gather(solver->state().particles)) << "frame " << frame;
    EXPECT_GE(report.readback_ms, 0.0);
    EXPECT_LE(report.readback_ms, report.frame_ms);
  }
}

TEST_P(ReadbackModes, DeliversAppendedParticles) {
  const auto solver = tiny_solver(GetParam());
  solver->advance();
  const std::size_t before = solver->positions().count;
  Particles drop;
  drop.add(0, {0.1, 0.25, 0.1}, {0.0, -1.0, 0.0});
  solver->append(drop);
  const auto report = solver->advance();
  EXPECT_GT(solver->positions().count, before);
  EXPECT_EQ(solver->positions().count, static_cast<std::size_t>(report.particles));
  EXPECT_EQ(gather(solver->positions()), gather(solver->state().particles));
}

TEST_P(ReadbackModes, DeliversNothingIfNotAsked) {
  const auto solver = tiny_solver(GetParam());
  const auto report = solver->advance(Delivery::nothing);
  EXPECT_EQ(solver->positions().count, 0u);
  EXPECT_EQ(report.readback_bytes, 0u);
  EXPECT_EQ(report.readback_ms, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Opencl, ReadbackModes,
                         testing::Values(Readback::blocking, Readback::pinned, Readback::mapped));

TEST(Readback, NoneLeavesTheStateOnTheDevice) {
  const auto solver = tiny_solver(Readback::none);
  const auto report = solver->advance();
  EXPECT_EQ(solver->positions().count, 0u);
  EXPECT_EQ(report.readback_bytes, 0u);
}

TEST(Readback, CountsBytes) {
  const auto blocking = tiny_solver(Readback::blocking)->advance();
  const auto pinned = tiny_solver(Readback::pinned)->advance();
  const auto positions = 16 * static_cast<std::uint64_t>(pinned.particles);
  EXPECT_EQ(pinned.readback_bytes, positions);
  EXPECT_EQ(blocking.readback_bytes, positions * static_cast<std::uint64_t>(blocking.substeps));
  const auto mapped = tiny_solver(Readback::mapped)->advance();
  EXPECT_TRUE(mapped.readback_bytes == 0 || mapped.readback_bytes == 2 * positions) << mapped.readback_bytes;
}

TEST(Readback, DoesNotChangeTheWater) {
  const auto run = [](Readback readback) {
    const auto solver = tiny_solver(readback);
    for (int frame = 0; frame < k_frames; ++frame) solver->advance();
    return gather(solver->state().particles);
  };
  const auto expected = run(Readback::none);
  for (const auto mode : {Readback::blocking, Readback::pinned, Readback::mapped}) EXPECT_EQ(run(mode), expected);
}

TEST(Profile, SaysWhatThePhasesCost) {
  Settings settings;
  settings.profile = true;
  const auto solver = tiny_solver(Readback::pinned, settings);
  const auto report = solver->advance();
  for (const char* phase : {"sort", "density", "forces", "readback"}) {
    ASSERT_TRUE(report.phase_ms.contains(phase)) << phase;
    EXPECT_GT(report.phase_ms.at(phase), 0.0) << phase;
  }
  EXPECT_TRUE(tiny_solver(Readback::pinned)->advance().phase_ms.empty());
}

TEST(Solver, RunsWithoutParticles) {
  Scene scene = tiny_scene();
  scene.rains.clear();
  const auto solver = opencl::make_solver(scene, Settings{});
  solver->load({});
  const auto report = solver->advance();
  EXPECT_EQ(report.particles, 0);
  EXPECT_EQ(report.active, 0);
  EXPECT_EQ(report.density_error_mean, 0.0);
  EXPECT_EQ(solver->positions().count, 0u);
  EXPECT_EQ(solver->state().particles.size(), 0u);
}

TEST(Solver, SharesNothingWithAnother) {
  const auto alone = tiny_solver(Readback::mapped);
  alone->advance();
  alone->advance();
  const auto one = tiny_solver(Readback::mapped);
  const auto other = tiny_solver(Readback::mapped);
  one->advance();
  other->advance();
  one->advance();
  EXPECT_EQ(gather(one->positions()), gather(alone->positions()));
}

}  // namespace
}  // namespace squall::opencl
