#include <algorithm>
#include <cmath>

#include "harness/measures.h"
#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

double standard_deviation_of_height(const Particles& particles) {
  double mean = 0.0, square = 0.0;
  for (const auto& x : particles.positions) mean += x.y() / static_cast<double>(particles.size());
  for (const auto& x : particles.positions)
    square += (x.y() - mean) * (x.y() - mean) / static_cast<double>(particles.size());
  return std::sqrt(square);
}

double mean_height(const Particles& particles) {
  double mean = 0.0;
  for (const auto& x : particles.positions) mean += x.y() / static_cast<double>(particles.size());
  return mean;
}

}  // namespace

/// A layer, a row and a column of particles on the floor come to rest, a layer and a row at one height.
void thin_layers(Bench bench, Outcome outcome) {
  struct Shape {
    const char* name;
    Eigen::Vector3i layers;
  };
  for (const Shape& shape : {Shape{"layer", {8, 1, 6}}, Shape{"row", {8, 1, 1}}, Shape{"column", {1, 6, 1}}}) {
    const Scene scene = stress_pool(shape.layers);
    const auto solver = bench.make(scene);
    run_seconds(*solver, bench.quick() ? 1.0 : 3.0);
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    outcome.at_most(std::string(shape.name) + ": mean speed [m/s]", rms_speed(now), 0.02);
    if (shape.layers.y() == 1)
      outcome.at_most(std::string(shape.name) + ": spread of heights [dx]",
                      standard_deviation_of_height(now) / k_stress_spacing, 0.1);
  }
}

void tall_column(Bench bench, Outcome outcome) {
  const int layers = 36;
  Scene scene = stress_pool({5, layers, 5});
  scene.time.frame_rate_hz = 100.0;
  const auto solver = bench.make(scene);
  const double depth = layers * k_stress_spacing;
  run_seconds(*solver, bench.quick() ? 0.5 : 2.0);
  const Course course = run_seconds(*solver, 0.2);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.at_most("largest over-density", course.max_density_error, 0.01);
  outcome.at_most("mean speed [of a fall through the depth]",
                  rms_speed(now) / std::sqrt(2.0 * k_stress_gravity * depth), 0.01);
  outcome.equal("pressure solves that were cut short", static_cast<double>(course.unconverged), 0.0);
}

/// A lattice against floor, walls, edges and corners has rest density everywhere: walls count as the water they
/// replace.
void corner_lattice(Bench bench, Outcome outcome) {
  Scene scene = stress_pool({8, 8, 8});
  scene.solver.dt_max_s = 1e-4;
  const auto solver = bench.make(scene);
  const Course course = run_frames(*solver, 1);
  outcome.at_most("largest over-density at the start", course.last_density_error, 0.005);
}

/// A million steps at rest: no heat, no leak, no loss of volume.
void long_rest(Bench bench, Outcome outcome) {
  Scene scene = stress_pool({6, 6, 6});
  scene.time.frame_rate_hz = 50.0;
  const auto solver = bench.make(scene);
  run_seconds(*solver, 5.0);
  const Particles begin = solver->state().particles;
  const double energy = total_energy(scene, begin), level = mean_height(begin);
  // the reference is the plain specification: fewer steps have to do
  const std::int64_t steps = bench.quick() ? 5'000 : bench.backend() == "omp" ? 1'000'000 : 100'000;
  Course course;
  std::int64_t done = 0, clamps = 0;
  while (done < steps) {
    course = run_frames(*solver, 50);
    done += course.substeps;
    clamps += course.clamps;
  }
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.information("steps", static_cast<double>(done));
  outcome.information("times a particle was put back behind a wall", static_cast<double>(clamps));
  outcome.at_most("change of energy [of the start's]", std::abs(total_energy(scene, now) / energy - 1.0), 1e-3);
  outcome.at_most("drift of the mean height [dx]", std::abs(mean_height(now) - level) / k_stress_spacing, 0.05);
  outcome.equal("particles left", static_cast<double>(now.size()), static_cast<double>(begin.size()));
}

}  // namespace squall::harness::stress
