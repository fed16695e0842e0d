// dfsph on every backend that has it gives the reference's bits where that is not a matter of course: few particles and
// odd numbers of them, more threads than processors, starts that are too dense, smoothing, drag, walls that vanish.
#include "core/scene.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

/// Each shape of the OpenCL kernels, and work cut otherwise than a device's default.
std::vector<BackendUnderTest> opencl_shapes(Precision precision) {
  std::vector<BackendUnderTest> all = {opencl("particles", Simd::scalar, Pressure::dfsph, precision),
                                       opencl("narrow", Simd::avx2, Pressure::dfsph, precision),
                                       opencl("wide", Simd::avx512, Pressure::dfsph, precision)};
  all.push_back(all[0]);
  all.back().name += " in groups of 16";
  all.back().settings.work.group = 16;
  all.push_back(all[1]);
  all.back().name += " in many parts";
  all.back().settings.work.parts = 13;
  return all;
}

/// The reference and beside it every way of running omp, each number of threads with each instruction set, and OpenCL.
class Beside {
 public:
  Beside(const Scene& scene, Precision precision) : expected_(reference(precision, Pressure::dfsph).make(scene)) {
    for (const int threads : {1, 2, 3, 5})
      for (const Simd simd : processor_simd()) {
        names_.push_back(std::to_string(threads) + " threads, " + to_string(simd));
        solvers_.push_back(omp("any", threads, simd, Pressure::dfsph, precision).make(scene));
      }
    for (const BackendUnderTest& shape : opencl_shapes(precision)) {
      names_.push_back(shape.name);
      solvers_.push_back(shape.make(scene));
    }
  }

  void load(const Particles& particles) {
    expected_->load(particles);
    for (auto& solver : solvers_) solver->load(particles);
  }

  void run(int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      const FrameReport& expected = expected_->advance();
      const Particles particles = expected_->state().particles;
      for (std::size_t i = 0; i < solvers_.size(); ++i) {
        SCOPED_TRACE(names_[i] + ", frame " + std::to_string(frame));
        const FrameReport& report = solvers_[i]->advance();
        ASSERT_EQ(first_difference(solvers_[i]->state().particles, particles), "");
        ASSERT_EQ(report.active, expected.active);
        ASSERT_EQ(report.density_iterations, expected.density_iterations);
        ASSERT_EQ(report.divergence_iterations, expected.divergence_iterations);
        ASSERT_EQ(report.density_iterations_max, expected.density_iterations_max);
        ASSERT_EQ(report.divergence_iterations_max, expected.divergence_iterations_max);
        ASSERT_EQ(report.light_passes, expected.light_passes);
        ASSERT_EQ(report.unconverged, expected.unconverged);
        ASSERT_EQ(report.clamps, expected.clamps);
        ASSERT_EQ(report.max_acceleration, expected.max_acceleration);
        ASSERT_EQ(report.density_error_max, expected.density_error_max);
        ASSERT_EQ(report.neighbours_mean, expected.neighbours_mean);
        EXPECT_EQ(report.light_passes_ms > 0.0, solvers_[i]->info().backend == "omp") << "OpenCL does not time them";
      }
    }
  }

  const FrameReport& report() const { return expected_->report(); }

 private:
  std::unique_ptr<Solver> expected_;
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<Solver>> solvers_;
};

/// Clumps, lone particles, particles on faces: bits, not physics. In solvers that have room for just these, or for
/// more.
void load_and_compare(Beside& all, const Scene& scene, std::size_t count) {
  SCOPED_TRACE(std::to_string(count) + " particles");
  const Eigen::Vector3d size = scene.container_size();
  all.load(random_particles(count, Eigen::Vector3d::Zero(), {size.x(), 0.15, size.z()}, 0.5, 3));
  all.run(2);
  EXPECT_EQ(all.report().active, static_cast<std::int64_t>(count));
  EXPECT_GE(all.report().density_iterations_max, 2) << "two at least, also of nothing";
}

class DfsphBits : public testing::TestWithParam<Precision> {};

INSTANTIATE_TEST_SUITE_P(Precisions, DfsphBits, testing::ValuesIn(k_precisions),
                         [](const auto& info) { return to_string(info.param); });

TEST_P(DfsphBits, OfFewAndOddNumbersOfParticles) {
  for (const std::size_t room : {0u, 257u}) {
    const Scene scene = one_substep_tank(room);
    Beside all(scene, GetParam());
    for (const std::size_t count : {257u, 65u, 64u, 63u, 17u, 16u, 15u, 9u, 8u, 7u, 2u, 1u, 0u})
      if (count <= room) load_and_compare(all, scene, count);
  }
}

// Five threads share out what there is for five: 256 particles each.
TEST(DfsphBitsInSingle, OfStartsThatAreTooDenseOnMoreThreadsThanProcessors) {
  Scene scene = filled_tank(11);
  scene.container.max_m += Eigen::Vector3d::Constant(0.1);
  scene.time.frame_rate_hz = 250;
  Particles particles = initial_particles(scene);
  ASSERT_GT(particles.size(), 5u * 256u);
  for (auto& x : particles.positions) x = (x / std::cbrt(1.3)).cast<float>().cast<double>();
  Beside all(scene, Precision::single_precision);
  all.load(particles);
  all.run(2);
  EXPECT_GT(all.report().density_iterations, 2 * all.report().substeps);
}

// More iterations of both solves than OpenCL enqueues at once: at most 16 before the host looks again, in the first
// sub-step 1 or 2 and then twice as many each time, 30 until it comes to those 16.
TEST(DfsphBitsInSingle, OfSolvesThatTakeManyIterations) {
  Scene scene = filled_tank(5);
  scene.container.max_m.x() += 0.2;
  scene.solver.density_tolerance = scene.solver.divergence_tolerance = 1e-7;
  scene.solver.max_iterations = 300;
  scene.time.frame_rate_hz = 250;
  Particles particles = initial_particles(scene);
  for (std::size_t i = 0; i < particles.size(); ++i) particles.velocities[i].y() = i % 2 == 0 ? -0.5 : 0.0;
  Beside all(scene, Precision::single_precision);
  all.load(particles);
  all.run(1);
  EXPECT_GT(all.report().density_iterations_max, 30);
  EXPECT_GT(all.report().divergence_iterations_max, 30);
  all.run(1);
}

// Every term that a scene can name, a box that vanishes and a block that is let go on the way.
TEST_P(DfsphBits, WithSmoothingViscosityDragAndVanishingWalls) {
  for (const bool viscous : {false, true}) {
    SCOPED_TRACE(viscous ? "viscous" : "without viscosity");
    Scene scene = filled_tank(4);
    scene.container.open_top = true;
    scene.fluid.viscosity_m2_s.reset();
    if (viscous) scene.fluid.viscosity_m2_s = 1e-3;
    scene.solver.xsph = 0.1;
    scene.rains.push_back(rain_over_tank(300));
    scene.boxes = {{{0.05, 0.22, 0.05}, {0.15, 0.3, 0.15}, 0.03}};
    Beside all(scene, GetParam());
    all.load(initial_particles(scene));
    all.run(5);
    EXPECT_GT(all.report().smoothing_viscosity, 0.0);
  }
}

}  // namespace
}  // namespace squall::test
