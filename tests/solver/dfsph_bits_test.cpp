// dfsph on every backend that has it gives the reference's bits where that is not a matter of course: few particles and
// odd numbers of them, more threads than processors, starts that are too dense, smoothing, drag, walls that vanish.
#include "core/scene.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

/// The reference and beside it every way of running omp: each number of threads with each instruction set.
class Beside {
 public:
  explicit Beside(const Scene& scene) : expected_(reference(Precision::single_precision, Pressure::dfsph).make(scene)) {
    for (const int threads : {1, 2, 3, 5})
      for (const Simd simd : processor_simd()) {
        names_.push_back(std::to_string(threads) + " threads, " + to_string(simd));
        solvers_.push_back(omp("any", threads, simd, Pressure::dfsph).make(scene));
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
        EXPECT_GT(report.light_passes_ms, 0.0);
      }
    }
  }

  const FrameReport& report() const { return expected_->report(); }

 private:
  std::unique_ptr<Solver> expected_;
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<Solver>> solvers_;
};

/// Clumps, lone particles, particles on faces: bits, not physics.
TEST(DfsphBits, OfFewAndOddNumbersOfParticles) {
  for (const std::size_t count : {0, 1, 2, 7, 8, 9, 15, 16, 17, 63, 64, 65, 257}) {
    SCOPED_TRACE(std::to_string(count) + " particles");
    const Scene scene = one_substep_tank(count);
    const Eigen::Vector3d size = scene.container_size();
    Beside all(scene);
    all.load(random_particles(count, Eigen::Vector3d::Zero(), {size.x(), 0.15, size.z()}, 0.5, 3));
    all.run(2);
    EXPECT_EQ(all.report().active, static_cast<std::int64_t>(count));
    EXPECT_GE(all.report().density_iterations_max, 2) << "two at least, also of nothing";
  }
}

// Five threads share out what there is for five: 256 particles each.
TEST(DfsphBits, OfStartsThatAreTooDenseOnMoreThreadsThanProcessors) {
  Scene scene = filled_tank(11);
  scene.container.max_m += Eigen::Vector3d::Constant(0.1);
  scene.time.frame_rate_hz = 250;
  Particles particles = initial_particles(scene);
  ASSERT_GT(particles.size(), 5u * 256u);
  for (auto& x : particles.positions) x = (x / std::cbrt(1.3)).cast<float>().cast<double>();
  Beside all(scene);
  all.load(particles);
  all.run(2);
  EXPECT_GT(all.report().density_iterations, 2 * all.report().substeps);
}

// Every term that a scene can name, a box that vanishes and a block that is let go on the way.
TEST(DfsphBits, WithSmoothingViscosityDragAndVanishingWalls) {
  for (const bool viscous : {false, true}) {
    SCOPED_TRACE(viscous ? "viscous" : "without viscosity");
    Scene scene = filled_tank(4);
    scene.container.open_top = true;
    scene.fluid.viscosity_m2_s.reset();
    if (viscous) scene.fluid.viscosity_m2_s = 1e-3;
    scene.solver.xsph = 0.1;
    scene.rains.push_back(rain_over_tank(300));
    scene.boxes = {{{0.05, 0.22, 0.05}, {0.15, 0.3, 0.15}, 0.03}};
    Beside all(scene);
    all.load(initial_particles(scene));
    all.run(5);
    EXPECT_GT(all.report().smoothing_viscosity, 0.0);
  }
}

}  // namespace
}  // namespace squall::test
