// What every read-back mode promises, on whole solvers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "backend_opencl/opencl_backend.h"
#include "backend_opencl/program.h"
#include "backend_opencl/shared_memory.h"
#include "core/state_hash.h"

namespace squall::opencl {
namespace {

using Places = std::vector<Eigen::Vector3f>;

constexpr Readback k_delivering[] = {Readback::blocking, Readback::pinned, Readback::mapped, Readback::async,
                                     Readback::quantized};

Scene tiny_scene() { return load_scene(SQUALL_TEST_SCENES_DIR "/tiny.toml"); }

std::unique_ptr<Solver> make(const Scene& scene, Readback readback, Settings settings = {}) {
  settings.readback = readback;
  auto solver = opencl::make_solver(scene, settings);
  solver->load(initial_particles(solver->scene()));
  return solver;
}

std::unique_ptr<Solver> tiny_solver(Readback readback) { return make(tiny_scene(), readback); }

Places places(const PositionsView& view) {
  Places result;
  for (std::size_t i = 0; i < view.count; ++i) result.push_back(view.position(i));
  return result;
}

Places places(const Particles& particles) {
  Places result;
  for (const auto& x : particles.positions) result.push_back(x.cast<float>());
  return result;
}

/// Plays a solver and holds what it delivers against its own states, frame by frame.
class Witness {
 public:
  explicit Witness(Solver& solver) : solver_(solver) { remember(); }

  void advance() {
    solver_.advance();
    const PositionsView view = solver_.positions();
    const Places shown = places(view);
    const Eigen::Vector3f bound = view.error_bound();
    remember();
    const bool late = solver_.settings().readback == Readback::async;
    ASSERT_EQ(view.frame, solver_.clock().frame - (late ? 1 : 0));
    const Places& expected = states_.at(view.frame);
    ASSERT_EQ(shown.size(), expected.size()) << "frame " << view.frame;
    for (std::size_t i = 0; i < shown.size(); ++i)
      ASSERT_TRUE(((shown[i] - expected[i]).cwiseAbs().array() <= bound.array()).all())
          << "frame " << view.frame << ", particle " << i << ": " << shown[i].transpose() << " for "
          << expected[i].transpose();
  }

  /// After a restore or load; not after an append, whose particles async does not show in the frame before.
  void remember() { states_[solver_.clock().frame] = places(solver_.state().particles); }

 private:
  Solver& solver_;
  std::map<std::uint64_t, Places> states_;
};

class ReadbackModes : public testing::TestWithParam<Readback> {
 protected:
  bool late() const { return GetParam() == Readback::async; }
};

// Two drops join in every frame, a block is released and a box vanishes.
TEST_P(ReadbackModes, DeliversTheStateOfTheFrameItNames) {
  const auto solver = tiny_solver(GetParam());
  Witness witness(*solver);
  const std::int64_t before = solver->report().particles;
  for (int frame = 0; frame < 8; ++frame) {
    ASSERT_NO_FATAL_FAILURE(witness.advance());
    EXPECT_GE(solver->report().readback_ms, 0.0);
    EXPECT_LE(solver->report().readback_ms, solver->report().frame_ms);
    EXPECT_EQ(solver->report().readback_latency_frames, late() ? 1 : 0);
  }
  EXPECT_GT(solver->report().particles, before);
}

TEST_P(ReadbackModes, DeliversAppendedParticles) {
  const auto solver = tiny_solver(GetParam());
  Witness witness(*solver);
  ASSERT_NO_FATAL_FAILURE(witness.advance());
  Particles drop;
  drop.add(0, {0.1, 0.25, 0.1}, {0.0, -1.0, 0.0});
  solver->append(drop);
  EXPECT_EQ(solver->positions().count, 0u) << "a view does not outlive a change";
  for (int frame = 0; frame < 3; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());
}

TEST_P(ReadbackModes, GoesOnFromARestoredState) {
  const auto solver = tiny_solver(GetParam());
  Witness witness(*solver);
  ASSERT_NO_FATAL_FAILURE(witness.advance());
  const State early = solver->state();
  for (int frame = 0; frame < 3; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());
  solver->restore(early);
  EXPECT_EQ(solver->positions().count, 0u);
  for (int frame = 0; frame < 3; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());
  solver->load(initial_particles(solver->scene()));
  EXPECT_EQ(solver->positions().count, 0u);
  witness.remember();
  for (int frame = 0; frame < 3; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());
}

TEST_P(ReadbackModes, DeliversNothingIfNotAsked) {
  const auto solver = tiny_solver(GetParam());
  Witness witness(*solver);
  ASSERT_NO_FATAL_FAILURE(witness.advance());
  const auto report = solver->advance(Delivery::nothing);
  EXPECT_EQ(solver->positions().count, 0u);
  EXPECT_EQ(report.readback_bytes, 0u);
  EXPECT_EQ(report.readback_copied_bytes, 0u);
  EXPECT_EQ(report.readback_latency_frames, 0);
  EXPECT_EQ(report.readback_ms, 0.0);
  witness.remember();
  for (int frame = 0; frame < 2; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());
}

TEST_P(ReadbackModes, DeliversFromNoParticlesOn) {
  const auto solver = tiny_solver(GetParam());
  solver->load({});
  Witness witness(*solver);
  for (int frame = 0; frame < 4; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());  // only rain
  EXPECT_GT(solver->positions().count + solver->state().particles.size(), 0u);
  Scene dry = tiny_scene();
  dry.rains.clear();
  const auto empty = make(dry, GetParam());
  empty->load({});
  for (int frame = 0; frame < 2; ++frame) {
    const auto report = empty->advance();
    EXPECT_EQ(report.particles, 0);
    EXPECT_EQ(report.active, 0);
    EXPECT_EQ(report.density_error_mean, 0.0);
    EXPECT_EQ(empty->positions().count, 0u);
    EXPECT_EQ(report.readback_copied_bytes, 0u);
  }
}

TEST_P(ReadbackModes, DeliversOneParticleAndMarksALostOne) {
  const auto solver = tiny_solver(GetParam());
  Particles one;
  one.add(0, {0.1, 0.1, 0.1}, {0.5, 0.5, 0.5});
  solver->load(one);
  Witness witness(*solver);
  for (int frame = 0; frame < 3; ++frame) ASSERT_NO_FATAL_FAILURE(witness.advance());
  one.add(1, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()), {0, 0, 0});
  solver->load(one);
  for (int frame = 0; frame < 3; ++frame) {
    solver->advance();
    const PositionsView view = solver->positions();
    std::size_t lost = 0;
    for (std::size_t i = 0; i < view.count; ++i) lost += view.lost(i) ? 1 : 0;
    EXPECT_EQ(lost, 1u);
  }
}

TEST_P(ReadbackModes, LeavesTheWaterAlone) {
  const auto hash_after = [](Readback readback) {
    const auto solver = tiny_solver(readback);
    for (int frame = 0; frame < 6; ++frame) solver->advance();
    return state_hash(solver->state().particles, Precision::single_precision);
  };
  EXPECT_EQ(hash_after(GetParam()), hash_after(Readback::none));
}

// Two solvers advance in turn, one of them with another mode; a third checks that neither disturbs the other.
TEST_P(ReadbackModes, SharesNothingWithAnotherSolver) {
  const auto one = tiny_solver(GetParam()), twin = tiny_solver(GetParam()), other = tiny_solver(Readback::async);
  Witness first(*one), second(*twin), third(*other);
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_NO_FATAL_FAILURE(first.advance());
    ASSERT_NO_FATAL_FAILURE(third.advance());
    ASSERT_NO_FATAL_FAILURE(second.advance());
  }
}

INSTANTIATE_TEST_SUITE_P(Opencl, ReadbackModes, testing::ValuesIn(k_delivering),
                         [](const auto& mode) { return std::string(to_string(mode.param)); });

TEST(Readback, NoneLeavesTheStateOnTheDevice) {
  const auto solver = tiny_solver(Readback::none);
  const auto report = solver->advance();
  EXPECT_EQ(solver->positions().count, 0u);
  EXPECT_EQ(report.readback_bytes, 0u);
  EXPECT_EQ(report.readback_copied_bytes, 0u);
}

// 12 bytes per position reach the caller, 6 in 16 bits. Float4 are written twice, by the kernel and by the transfer;
// where memory is shared the kernel's codes are all that is written, and mapping writes nothing.
TEST(Readback, CountsBytes) {
  Machine machine = open_machine(Settings{});
  auto kernels = embedded_kernels();
  std::erase_if(kernels, [](const auto& kernel) { return std::string(kernel.file) != "kernels/probe_memory.cl"; });
  const bool shared = shares_host_memory(machine, build_program(machine.context, machine.device, kernels, ""));
  for (const Readback mode : k_delivering) {
    const auto solver = tiny_solver(mode);
    solver->advance();
    const auto report = solver->advance();
    const std::uint64_t n = solver->positions().count;
    std::map<Readback, std::uint64_t> copied{{Readback::pinned, 32 * n},
                                             {Readback::async, 32 * n},
                                             {Readback::mapped, shared ? 0 : 32 * n},
                                             {Readback::quantized, shared ? 6 * n : 12 * n},
                                             {Readback::blocking, 32 * n * std::uint64_t(report.substeps)}};
    EXPECT_EQ(report.readback_bytes, n * (mode == Readback::quantized ? 6 : 12)) << to_string(mode);
    EXPECT_EQ(report.readback_copied_bytes, copied.at(mode)) << to_string(mode);
  }
}

// The view stays readable through the next frame: another thread may draw it meanwhile.
TEST(Readback, AsyncLeavesThePreviousViewAlone) {
  const auto solver = tiny_solver(Readback::async);
  solver->advance();
  solver->advance();
  for (int frame = 0; frame < 4; ++frame) {
    const PositionsView view = solver->positions();
    const Places before = places(view);
    solver->advance();
    EXPECT_EQ(places(view), before);
    EXPECT_NE(solver->positions().data, view.data);
    EXPECT_NE(places(solver->positions()), before);
  }
}

TEST(Readback, QuantizedStatesARangeThatHoldsEverything) {
  for (const bool open_top : {true, false}) {
    Scene scene = tiny_scene();
    scene.container.open_top = open_top;
    if (!open_top) scene.rains.clear();
    const auto solver = make(scene, Readback::quantized);
    solver->advance();
    const PositionsView view = solver->positions();
    EXPECT_EQ(view.format, PositionFormat::unorm16);
    EXPECT_EQ(view.stride, 6u);
    EXPECT_EQ(view.offset, Eigen::Vector3f::Zero());
    const Eigen::Vector3d size = scene.container_size();
    const Eigen::Vector3d top = 65534.0 * view.scale.cast<double>();
    const double heights = open_top ? 11.0 : 1.0;  // lost is further away than ten heights
    const double rounding = 4 * static_cast<double>(std::numeric_limits<float>::epsilon());
    EXPECT_NEAR(top.x(), size.x(), rounding * size.x());
    EXPECT_NEAR(top.y(), heights * size.y(), rounding * heights * size.y());
    EXPECT_NEAR(top.z(), size.z(), rounding * size.z());
  }
}

TEST(Profile, SaysWhatThePhasesCost) {
  Settings settings;
  settings.pressure = Pressure::wcsph;
  settings.profile = true;
  for (const Readback mode : k_delivering) {
    const auto solver = make(tiny_scene(), mode, settings);
    const auto report = solver->advance();
    for (const char* phase : {"sort", "density", "forces"}) {
      ASSERT_TRUE(report.phase_ms.contains(phase)) << phase;
      EXPECT_GT(report.phase_ms.at(phase), 0.0) << phase;
    }
    ASSERT_TRUE(report.phase_ms.contains("readback"));
    EXPECT_DOUBLE_EQ(report.readback_copy_ms, report.phase_ms.at("readback"));
    EXPECT_GE(report.readback_hidden_ms, 0.0);
    EXPECT_LE(report.readback_hidden_ms, report.readback_copy_ms);
  }
  EXPECT_TRUE(tiny_solver(Readback::pinned)->advance().phase_ms.empty());
}

}  // namespace
}  // namespace squall::opencl
