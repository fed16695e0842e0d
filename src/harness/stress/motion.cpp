#include <algorithm>
#include <cmath>
#include <string>

#include "core/errors.h"
#include "harness/measures.h"
#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

/// Largest energy after any frame [of `start`, J].
double highest_energy(Solver& solver, double start, double seconds, Course& course) {
  const Scene& scene = solver.scene();
  double highest = 0.0;
  const int frames = static_cast<int>(std::lround(seconds * scene.time.frame_rate_hz));
  for (int frame = 0; frame < frames; ++frame) {
    const Course one = run_frames(solver, 1);
    course.substeps += one.substeps;
    course.clamps += one.clamps;
    course.active = one.active;
    course.max_speed = std::max(course.max_speed, one.max_speed);
    highest = std::max(highest, total_energy(scene, solver.state().particles) / start);
  }
  return highest;
}

Particles one_drop(const Eigen::Vector3d& position, double speed) {
  Particles drop;
  drop.add(0, position, {0.0, -speed, 0.0});
  return in_single(drop);
}

}  // namespace

/// A cube of water falls 0.4 m, and 1 m, onto the floor.
void impact(Bench bench, Outcome outcome) {
  for (const double height : {0.4, 1.0}) {
    Scene scene = stress_block({0.6, 1.6, 0.6}, {8, 8, 8}, {0.1, height, 0.1});
    scene.time.frame_rate_hz = 200.0;
    const auto solver = bench.make(scene);
    const double start = total_energy(scene, solver->state().particles);
    Course fall, blow, splash;
    double highest = highest_energy(*solver, start, std::sqrt(2.0 * height / k_stress_gravity) - 0.005, fall);
    highest = std::max(highest, highest_energy(*solver, start, 0.05, blow));
    highest = std::max(highest, highest_energy(*solver, start, bench.quick() ? 0.2 : 1.0, splash));
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    const std::string from = height < 1.0 ? "from 0.4 m: " : "from 1 m: ";
    outcome.at_most(from + "highest energy [of the start's]", highest, 1.001);
    outcome.at_most(from + "put back behind a wall in the blow, per particle and step",
                    static_cast<double>(blow.clamps) / static_cast<double>(blow.substeps * blow.active), 1e-3);
    outcome.at_most(from + "furthest outside [m]", furthest_outside(scene, now), 0.0);
  }
}

/// Müller's three kernels without viscosity: pressure gradient and density do not belong together, and energy grows.
void mixed_kernels(Bench bench, Outcome outcome) {
  Scene scene = stress_block({1.6, 1.6, 0.4}, {8, 16, 8});
  scene.time.frame_rate_hz = 100.0;
  const auto solver = bench.make(scene);
  Course course;
  const double start = total_energy(scene, solver->state().particles);
  const double highest = highest_energy(*solver, start, 1.0, course);
  expect_sound(*solver, solver->state().particles, outcome);
  outcome.at_most("highest energy in the first second [of the start's]", highest, 1.001);
}

/// The container is jerked by 10 g for 50 ms, one way and the other, and has two seconds to calm down.
void jerk(Bench bench, Outcome outcome) {
  for (const double way : {1.0, -1.0}) {
    Scene scene = stress_block({0.8, 1.0, 0.4}, {16, 6, 8});
    scene.time.frame_rate_hz = 100.0;
    scene.container.motions.push_back({0.1, 0.05, {}, Eigen::Vector3d(way * 10.0 * k_stress_gravity, 0.0, 0.0)});
    scene.container.motions.push_back({0.15, 0.05, {}, Eigen::Vector3d(-way * 10.0 * k_stress_gravity, 0.0, 0.0)});
    const auto solver = bench.make(scene);
    const Course course = run_seconds(*solver, bench.quick() ? 0.6 : 2.5);
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    const std::string to = way > 0.0 ? "to the right: " : "to the left: ";
    outcome.information(to + "times put back behind a wall", static_cast<double>(course.clamps));
    outcome.at_most(to + "furthest outside [m]", furthest_outside(scene, now), 0.0);
    outcome.equal(to + "particles left", static_cast<double>(now.size()), 16.0 * 6.0 * 8.0);
    // what the jerk gave them: 4.9 m/s, and the fall over the container's height
    outcome.at_most(to + "fastest particle [m/s]", course.max_speed,
                    2.0 * (10.0 * k_stress_gravity * 0.05 + std::sqrt(2.0 * k_stress_gravity * 1.0)));
  }
}

/// Walls faster than a spacing per step pass nobody; a jump that no step can follow is refused before anything moves.
void fast_walls(Bench bench, Outcome outcome) {
  Scene scene = stress_block({0.8, 1.0, 0.4}, {16, 6, 8});
  scene.time.frame_rate_hz = 100.0;
  scene.container.open_top = false;  // water that is hit at 47 m/s may well fly out
  // 0.5 m in 20 ms: 47 m/s on the way, a spacing in a millisecond, 7,217 m/s^2
  scene.container.motions.push_back({0.05, 0.02, Eigen::Vector3d(0.5, 0.0, 0.0), {}});
  const auto solver = bench.make(scene);
  const Course course = run_seconds(*solver, bench.quick() ? 0.2 : 1.0);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.at_most("furthest outside [m]", furthest_outside(scene, now), 0.0);
  outcome.information("times put back behind a wall", static_cast<double>(course.clamps));
  Scene jump = scene;
  jump.container.motions = {{0.05, 0.001, Eigen::Vector3d(10.0, 0.0, 0.0), {}}};
  bool refused = false;
  try {
    bench.make(jump);
  } catch (const InputError&) {
    refused = true;
  }
  outcome.equal("a jump of 10 m in 1 ms is refused", refused ? 1.0 : 0.0, 1.0);
}

/// A drop at 4 m/s meets a particle at rest, the dry floor, the rim, and water it starts inside of.
void drops(Bench bench, Outcome outcome) {
  const double speed = 4.0, spacing = k_stress_spacing;
  struct Meeting {
    const char* what;
    Eigen::Vector3d from;
    bool resident, water;
  };
  const double rim = 0.6;
  for (const Meeting& meeting : {Meeting{"a particle at rest", {0.4, 0.3, 0.2}, true, false},
                                 {"the dry floor", {0.4, 0.3, 0.2}, false, false},
                                 {"the rim", {0.0, rim + 0.1, 0.2}, false, false},
                                 {"water around it", {0.41, 0.13, 0.21}, false, true}}) {
    Scene scene = stress_tank({0.8, rim, 0.4});
    Particles particles = one_drop(meeting.from, speed);
    if (meeting.resident) particles.add(1, {0.4, 0.5 * spacing, 0.2}, Eigen::Vector3d::Zero());
    if (meeting.water)
      for (int i = 0; i < 16 * 4 * 8; ++i) {
        const Eigen::Vector3i index(i % 16, i / 16 % 4, i / 64);
        const Eigen::Vector3d at = spacing * (index.cast<double>().array() + 0.5).matrix();
        particles.add(static_cast<std::uint32_t>(1 + i), at, Eigen::Vector3d::Zero());
      }
    scene.solver.speed_of_sound_m_s = 10.0 * std::sqrt(2.0 * k_stress_gravity * rim);
    scene = with_room_for(scene, particles.size());
    const auto solver = bench.make(scene);
    solver->load(in_single(particles));
    const Course course = run_seconds(*solver, 0.2);
    expect_sound(*solver, solver->state().particles, outcome);
    const double fall = std::max(0.0, meeting.from.y()) * 2.0 * k_stress_gravity;
    outcome.at_most(std::string(meeting.what) + ": fastest [of the drop's speed]",
                    course.max_speed / std::sqrt(speed * speed + fall), 1.01);
  }
}

}  // namespace squall::harness::stress
