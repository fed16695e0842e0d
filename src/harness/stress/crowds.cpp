#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/errors.h"
#include "harness/measures.h"
#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

const Eigen::Vector3d k_tank{0.8, 0.6, 0.4};

/// Water that solves for pressure would iterate for long on heaps without an end in sight: a few show as much.
Scene crowded_tank(std::size_t count) {
  Scene scene = with_room_for(stress_tank(k_tank), count);
  scene.solver.max_iterations = 3;
  return scene;
}

/// Share of the particles that have another nearer than `distance`.
double share_nearer_than(const Particles& particles, double distance) {
  const auto nearest = nearest_distances(particles);
  const auto near = std::count_if(nearest.begin(), nearest.end(), [&](double d) { return d < distance; });
  return static_cast<double>(near) / static_cast<double>(nearest.size());
}

}  // namespace

void heap_at_a_point(Bench bench, Outcome outcome) {
  const std::size_t count = 1000;
  Particles heap;
  for (std::size_t i = 0; i < count; ++i)
    heap.add(static_cast<std::uint32_t>(i), {0.4, 0.3, 0.2}, Eigen::Vector3d::Zero());
  const Scene scene = crowded_tank(count);
  const auto solver = bench.make(scene);
  solver->load(in_single(heap));
  const Course course = run_frames(*solver, 10);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.equal("particles left", static_cast<double>(now.size()), static_cast<double>(count));
  outcome.at_most(
      "fastest particle [m/s]", course.max_speed,
      std::max(10.0 * std::sqrt(k_stress_gravity * scene.support_radius()), k_stress_spacing / scene.solver.dt_max_s));
}

/// A block packed too densely by `excess`, once for each time step: what one step makes of it must not be an explosion.
void over_dense_start(Bench bench, Outcome outcome) {
  for (const double excess : {0.001, 0.01, 0.05, 0.7})
    for (const double dt : {4e-3, 1e-3, 2.5e-4, 1e-4}) {
      const int n = 8;
      const double spacing = k_stress_spacing / std::cbrt(1.0 + excess);
      Scene scene = with_room_for(stress_tank({1.0, 1.0, 1.0}), n * n * n);
      scene.time.frame_rate_hz = std::min(1000.0, 1.0 / dt);
      scene.solver.dt_max_s = dt;
      const auto solver = bench.make(scene);
      const Particles start = shaken_cube(n, spacing, {0.3, 0.05, 0.3}, 0.0, 0.0, 1);
      solver->load(start);
      run_frames(*solver, 1);
      const Particles now = solver->state().particles;
      const double before = total_energy(scene, start), after = total_energy(scene, now);
      outcome.at_most("energy after " + std::to_string(dt * 1e3).substr(0, 4) + " ms steps, " +
                          std::to_string(excess * 100).substr(0, 4) + " % too dense [of the start's]",
                      after / before, 1.001);
      if (!is_finite(now)) outcome.equal("particles not finite", 1.0, 0.0);
    }
}

/// A cell holds them all, so that every one is the neighbour of every other. What such pressure does to them afterwards
/// is not judged, but they are all accounted for.
void all_in_one_cell(Bench bench, Outcome outcome) {
  const int n = bench.quick() ? 12 : 22;  // 1,728 or 10,648 particles
  const double edge = 0.9 * k_stress_spacing;
  const Particles crowd = shaken_cube(n, edge / n, {0.003, 0.003, 0.003}, 0.2 * edge / n, 0.0, 3);
  const auto solver = bench.make(crowded_tank(crowd.size()));
  solver->load(crowd);
  const Course course = run_frames(*solver, 1);
  outcome.equal("sub-steps of the frame", static_cast<double>(course.substeps), 1.0);
  outcome.equal("neighbours, mean", course.last_neighbours, static_cast<double>(crowd.size() - 1));
  const Particles now = solver->state().particles;
  outcome.equal("particles still held, lost ones included", static_cast<double>(now.size()),
                static_cast<double>(crowd.size()));
  outcome.equal("all states finite", is_finite(now) ? 1.0 : 0.0, 1.0);
}

/// Wide kernels make particles of a cubic spline pair up: the histogram of nearest distances shows it. To refuse them
/// is as good.
void pairing(Bench bench, Outcome outcome) {
  Scene scene = with_room_for(stress_tank({0.4, 0.6, 0.4}), 512);
  scene.fluid.support_ratio = 3.0;
  std::unique_ptr<Solver> solver;
  try {
    solver = bench.make(scene);
  } catch (const InputError&) {
    outcome.equal("H = 3 dx is refused", 1.0, 1.0);
    return;
  }
  solver->load(shaken_cube(8, k_stress_spacing, {0.025, 0.025, 0.025}, 0.1 * k_stress_spacing, 0.0, 5));
  run_seconds(*solver, bench.quick() ? 0.5 : 2.0);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.at_most("share of particles nearer than 0.4 dx to another, H = 3 dx",
                  share_nearer_than(now, 0.4 * k_stress_spacing), 0.0);
}

/// A block that is pulled apart in a void: no clumps where it tears.
void stretched(Bench bench, Outcome outcome) {
  Scene scene = with_room_for(stress_tank({4.0, 2.0, 2.0}), 1000);
  scene.gravity_m_s2.setZero();
  scene.solver.speed_of_sound_m_s = 20.0;
  Particles block = shaken_cube(10, k_stress_spacing, {1.775, 0.775, 0.775}, 0.0, 0.0, 1);
  const Eigen::Vector3d centre(2.0, 1.0, 1.0);
  for (std::size_t i = 0; i < block.size(); ++i) {
    const Eigen::Vector3d at = block.positions[i] - centre;
    block.velocities[i] = Eigen::Vector3d(2.0 * at.x(), -at.y(), -at.z());
  }
  block = in_single(block);
  const auto solver = bench.make(scene);
  solver->load(block);
  run_seconds(*solver, 0.5);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  const auto nearest = nearest_distances(now);
  outcome.at_least("smallest distance of two particles [dx]",
                   *std::min_element(nearest.begin(), nearest.end()) / k_stress_spacing, 0.5);
}

}  // namespace squall::harness::stress
