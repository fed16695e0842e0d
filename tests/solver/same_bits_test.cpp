// The promise of docs/determinism.md: the same scene gives the same bits on any number of threads, on any instruction
// set and on OpenCL. Every backend starts from one state and is compared after every frame, over 200 sub-steps in each
// of three windows of the three scenes of the 2016 report, with each pressure solver.
#include <functional>
#include <ostream>

#include "core/state_hash.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

struct Window {
  std::string name;
  std::string scene;
  double at_s;  // where the window begins
  /// What the test changes in the scene: it moves late events into reach.
  std::function<void(Scene&)> change = [](Scene&) {};
};

void PrintTo(const Window& window, std::ostream* out) { *out << window.name; }

void move_at_once(Scene& scene) {
  if (scene.container.motions.empty())
    scene.container.motions.push_back({0.0, 0.8, Eigen::Vector3d(-0.1, 0, 0), std::nullopt});
  scene.container.motions[0].start_s = 0.0;
  scene.container.motions[0].duration_s = 0.3;
}

void rain_hard(Scene& scene) { scene.rains.at(0).particles_per_s = 12000; }

const std::vector<Window>& windows() {
  static const std::vector<Window> all = {
      {"collapse_start", "collapse", 0.0},
      {"collapse_front_meets_wall", "collapse", 0.4},
      {"collapse_container_moves", "collapse", 0.05, move_at_once},
      {"drop_vanishing_boxes", "drop", 0.0834},
      {"drop_impact", "drop", 0.35},
      {"drop_container_moves", "drop", 0.15, move_at_once},
      {"rain_start", "rain", 0.0, rain_hard},
      {"rain_impact", "rain", 0.15, rain_hard},
      {"rain_container_moves", "rain", 0.1,
       [](Scene& scene) {
         rain_hard(scene);
         move_at_once(scene);
       }},
  };
  return all;
}

class SameBits : public testing::TestWithParam<std::tuple<Window, Pressure>> {
 protected:
  Scene scene() const {
    const Window& window = std::get<0>(GetParam());
    Scene made = load_scene(std::string(SQUALL_SCENES_DIR "/") + window.scene + ".toml");
    window.change(made);
    return made;
  }
};

INSTANTIATE_TEST_SUITE_P(Windows, SameBits,
                         testing::Combine(testing::ValuesIn(windows()),
                                          testing::Values(Pressure::wcsph, Pressure::mueller, Pressure::dfsph)),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" + to_string(std::get<1>(info.param));
                         });

/// The state a window begins with, computed by the first backend.
State state_at(const BackendUnderTest& first, const Scene& scene, double time_s) {
  const auto solver = first.make(scene);
  while (static_cast<double>(solver->clock().frame) / scene.time.frame_rate_hz < time_s)
    solver->advance(Delivery::nothing);
  return solver->state();
}

/// Runs both for `substeps` from `start` and expects the same bits, order and report after every frame.
class LockStep {
 public:
  LockStep(const std::vector<BackendUnderTest>& backends, const Scene& scene, const State& start)
      : backends_(backends) {
    for (const BackendUnderTest& backend : backends) {
      solvers_.push_back(backend.make(scene));
      solvers_.back()->restore(start);
    }
  }

  void run(int substeps) {
    for (int done = 0; done < substeps && !testing::Test::HasFatalFailure();) {
      done += solvers_[0]->advance().substeps;
      const State expected = solvers_[0]->state();
      const std::uint64_t hash = state_hash(expected.particles, precision());
      EXPECT_TRUE(hash != last_hash_ || expected.particles.size() == 0) << "nothing moved";
      last_hash_ = hash;
      for (std::size_t i = 1; i < solvers_.size(); ++i) {
        SCOPED_TRACE(testing::Message() << backends_[i].name << " against " << backends_[0].name << " after frame "
                                        << expected.clock.frame << ", " << done << " sub-steps on");
        solvers_[i]->advance();
        expect_equal(*solvers_[i], expected, hash);
      }
    }
  }

 private:
  void expect_equal(Solver& solver, const State& expected, std::uint64_t hash) {
    const State state = solver.state();
    const FrameReport& report = solver.report();
    const FrameReport& expected_report = solvers_[0]->report();
    ASSERT_EQ(state_hash(state.particles, precision()), hash) << first_difference(state.particles, expected.particles);
    ASSERT_EQ(state.particles.ids, expected.particles.ids) << "the same water in another order";
    ASSERT_EQ(state.clock.max_speed, expected.clock.max_speed);
    ASSERT_EQ(state.clock.max_acceleration, expected.clock.max_acceleration);
    ASSERT_EQ(report.clamps, expected_report.clamps);
    ASSERT_EQ(report.lost, expected_report.lost);
    ASSERT_EQ(report.density_error_max, expected_report.density_error_max);
    ASSERT_EQ(state.particles.pressures, expected.particles.pressures);
    ASSERT_EQ(report.density_iterations, expected_report.density_iterations);
    ASSERT_EQ(report.divergence_iterations, expected_report.divergence_iterations);
    ASSERT_EQ(report.density_iterations_max, expected_report.density_iterations_max);
    ASSERT_EQ(report.divergence_iterations_max, expected_report.divergence_iterations_max);
    ASSERT_EQ(report.unconverged, expected_report.unconverged);
    ASSERT_EQ(report.neighbours_mean, expected_report.neighbours_mean);
  }

  Precision precision() const { return backends_.front().settings.precision; }

  std::vector<BackendUnderTest> backends_;
  std::vector<std::unique_ptr<Solver>> solvers_;
  std::uint64_t last_hash_ = 0;
};

// dfsph does ten times the work in a sub-step and takes longer ones: fewer particles, fewer sub-steps.
TEST_P(SameBits, OnAnyNumberOfThreadsAndOnOpenCl) {
  const auto [window, pressure] = GetParam();
  Scene scene = this->scene();
  std::vector<BackendUnderTest> backends = {opencl("by_device", Simd::best, pressure),
                                            opencl("particles", Simd::scalar, pressure)};
  if (pressure == Pressure::dfsph) {
    scale_to_particles(scene, 3000);
    backends.push_back(omp("5_threads", 5, Simd::best, pressure));
  }
  for (const int threads : {1, 2, 3})
    backends.push_back(omp(std::to_string(threads) + "_threads", threads, Simd::best, pressure));
  LockStep(backends, scene, state_at(backends.back(), scene, window.at_s)).run(pressure == Pressure::dfsph ? 40 : 200);
}

// Every instruction set, every width of OpenCL kernels, and the specification in single precision; on fewer particles,
// because these are slow.
TEST_P(SameBits, OnAnyInstructionSetAndInTheReference) {
  const auto [window, pressure] = GetParam();
  Scene scene = this->scene();
  const bool dfsph = pressure == Pressure::dfsph;
  scale_to_particles(scene, dfsph ? 400 : 700);
  const std::vector<BackendUnderTest> backends = bitwise_backends(pressure);
  LockStep(backends, scene, state_at(backends.front(), scene, window.at_s)).run(dfsph ? 20 : 100);
}

// The same in double precision, where `reference` is the yardstick of all errors. The widest OpenCL kernels
// have their turn in the crowds below: a driver compiles for seconds for each scene's switches.
TEST_P(SameBits, InDoublePrecision) {
  const auto [window, pressure] = GetParam();
  Scene scene = this->scene();
  const bool dfsph = pressure == Pressure::dfsph;
  scale_to_particles(scene, dfsph ? 200 : 400);
  std::vector<BackendUnderTest> backends = bitwise_backends(pressure, Precision::double_precision);
  std::erase_if(backends, [](const BackendUnderTest& each) { return each.name == "opencl_double8"; });
  LockStep(backends, scene, state_at(backends.front(), scene, window.at_s)).run(dfsph ? 10 : 40);
}

// More neighbours than the OpenCL backend's lists and search batches hold (kernels/lists.h, search.h): 1,000 particles
// within reach of each other, and a thin crowd in which some lists fit and some do not. Bits, not physics.
TEST(SameBitsInCrowds, HoweverManyNeighboursThereAre) {
  const Scene scene = one_substep_tank(1400);
  const double reach = scene.support_radius();
  const Eigen::Vector3d corner(0.25, 0.25, 0.15);
  Particles crowd = random_particles(1000, corner, corner + Eigen::Vector3d::Constant(0.5 * reach), 0, 5);
  const Particles thin = random_particles(400, corner, corner + Eigen::Vector3d::Constant(2.5 * reach), 0, 6);
  for (std::size_t i = 0; i < thin.size(); ++i)
    crowd.add(static_cast<std::uint32_t>(1000 + i), thin.positions[i], thin.velocities[i]);
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph})
    for (const Precision precision : k_precisions) {
      const std::vector<BackendUnderTest> backends = bitwise_backends(pressure, precision);
      const auto first = backends.front().make(scene);
      first->load(crowd);
      LockStep(backends, scene, first->state()).run(3);
    }
}

class SameBitsInDenseCrowds : public testing::TestWithParam<Pressure> {};

INSTANTIATE_TEST_SUITE_P(Pressures, SameBitsInDenseCrowds,
                         testing::Values(Pressure::wcsph, Pressure::mueller, Pressure::dfsph),
                         [](const auto& info) { return to_string(info.param); });

// About as many candidates near a block as a search batch holds: among them blocks whose batch is full before the
// search has come to its end, and finds no more.
TEST_P(SameBitsInDenseCrowds, WhereOneBatchIsJustFull) {
  const Scene scene = one_substep_tank(2000);
  const double reach = scene.support_radius();
  const Eigen::Vector3d corner(0.15, 0.15, 0.1);
  const std::vector<BackendUnderTest> backends = {omp("2_threads", 2, Simd::best, GetParam()),
                                                  opencl("float8", Simd::avx2, GetParam()),
                                                  opencl("float16", Simd::avx512, GetParam())};
  for (unsigned seed = 0; seed < 24 && !HasFatalFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const double edge = (2.8 + 0.07 * seed) * reach;
    const auto first = backends.front().make(scene);
    first->load(random_particles(2000, corner, corner + Eigen::Vector3d::Constant(edge), 0, seed));
    LockStep(backends, scene, first->state()).run(1);
  }
}

// Lost ones between others and in long runs: more than the OpenCL backend's sorts keep in one bin
// (kernels/sort_bins.h).
TEST(SameBitsOfLostOnes, HoweverManyAreLost) {
  const Scene scene = one_substep_tank(1000);
  Particles torn = random_particles(1000, {0.05, 0.05, 0.05}, {0.75, 0.55, 0.35}, 0.3, 7);
  for (std::size_t i = 0; i < torn.size(); ++i)
    if (i % 3 == 1 || (i > 200 && i < 400)) torn.positions[i].x() = 100;
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph})
    for (const Precision precision : k_precisions) {
      const std::vector<BackendUnderTest> backends = bitwise_backends(pressure, precision);
      const auto first = backends.front().make(scene);
      first->load(torn);
      LockStep(backends, scene, first->state()).run(3);
      EXPECT_EQ(first->advance().lost, 466);
    }
}

}  // namespace
}  // namespace squall::test
