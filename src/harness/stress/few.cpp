#include <array>
#include <cmath>
#include <limits>

#include "harness/measures.h"
#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

const Eigen::Vector3d k_tank{0.8, 0.6, 0.4};

/// Half a metre of free fall lies below: no wall is met within `frames` milliseconds.
Scene room_to_fall(std::size_t particles) { return with_room_for(stress_tank({0.8, 2.0, 0.4}), particles); }

}  // namespace

/// There is no direction to push in: a good solver leaves them together or parts them gently.
void coincident_pair(Bench bench, Outcome outcome) {
  Particles pair;
  pair.add(0, {0.4, 1.5, 0.2}, Eigen::Vector3d::Zero());
  pair.add(1, {0.4, 1.5, 0.2}, Eigen::Vector3d::Zero());
  pair = in_single(pair);
  const auto solver = bench.make(room_to_fall(2));
  solver->load(pair);
  const int frames = 50;
  const Course course = run_frames(*solver, frames);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  const double fallen = k_stress_gravity * frames / 1000.0;
  // parting must not add more than the fall over one spacing would
  outcome.at_most("fastest particle [m/s]", course.max_speed,
                  fallen + std::sqrt(2.0 * k_stress_gravity * k_stress_spacing));
  outcome.information("distance after 50 ms [dx]", (now.positions[0] - now.positions[1]).norm() / k_stress_spacing);
}

/// r = H, just inside, and on the spline's knot at H/2: the change of velocity is that of the reference in double.
void ends_of_the_kernel(Bench bench, Outcome outcome) {
  double largest = 0.0, worst = 0.0, asymmetry = 0.0;
  for (const double share : {1.0, 1.0 - 1e-7, 0.5}) {
    Scene scene = room_to_fall(2);
    scene.gravity_m_s2.setZero();
    scene.solver.speed_of_sound_m_s = 10.0;
    const double distance = share * scene.support_radius();
    Particles pair;
    pair.add(0, {0.25, 0.5, 0.25}, {0.5, 0.0, 0.0});
    pair.add(1, {0.25 + distance, 0.5, 0.25}, {-0.5, 0.0, 0.0});
    pair = in_single(pair);
    const auto solver = bench.make(scene), exact = bench.in_double(scene);
    solver->load(pair);
    exact->load(pair);
    run_frames(*solver, 1);
    run_frames(*exact, 1);
    const Particles found = solver->state().particles, right = exact->state().particles;
    for (std::size_t i = 0; i < 2; ++i) {
      largest = std::max(largest, (right.velocities[i] - pair.velocities[right.ids[i]]).norm());
      worst = std::max(worst, (found.velocities[i] - right.velocities[i]).norm());
    }
    asymmetry = std::max(asymmetry, (found.velocities[0] + found.velocities[1]).norm());
  }
  // velocities of 0.5 m/s take one rounding per sub-step; the weight's 1 - r/H loses as much of the largest force
  outcome.at_most("velocity off the reference in double [m/s]", worst, bench.rounding(32.0, 0.5 + largest));
  outcome.at_most("momentum of the pair per mass [m/s]", asymmetry, bench.rounding(32.0, 0.5 + largest));
}

/// A thrown particle follows its parabola, which the leap-frog keeps exactly.
void lone_particle(Bench bench, Outcome outcome) {
  Particles one;
  one.add(0, {0.1, 1.2, 0.2}, {1.0, 2.0, 0.0});
  one = in_single(one);
  const auto solver = bench.make(room_to_fall(1));
  solver->load(one);
  const Course course = run_frames(*solver, 500);
  const double t = 0.5;
  const Eigen::Vector3d expected =
      one.positions[0] + t * one.velocities[0] + Eigen::Vector3d(0.0, -0.5 * k_stress_gravity * t * t, 0.0);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  // one rounding of a coordinate up to 2 m and of a speed up to 3 m/s in each sub-step, neither larger than that
  outcome.at_most("distance from the parabola [m]", (now.positions[0] - expected).norm(),
                  bench.rounding(static_cast<double>(course.substeps), 2.0 + 3.0 * t));
}

void hardly_any(Bench bench, Outcome outcome) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    Particles few;
    for (std::size_t i = 0; i < count; ++i)
      few.add(static_cast<std::uint32_t>(i), {0.2 + 0.06 * static_cast<double>(i), 0.1, 0.2}, Eigen::Vector3d::Zero());
    const auto solver = bench.make(with_room_for(stress_tank(k_tank), count));
    solver->load(in_single(few));
    run_frames(*solver, 100);
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    outcome.equal(std::to_string(count) + " particles: number after 100 steps", static_cast<double>(now.size()),
                  static_cast<double>(count));
  }
}

/// The sick one is lost and counted; the others do not notice, to the bit.
void not_numbers(Bench bench, Outcome outcome) {
  const Particles healthy = shaken_cube(6, k_stress_spacing, {0.1, 0.1, 0.1}, 0.01, 0.3, 7);
  const Scene scene = with_room_for(stress_tank(k_tank), healthy.size() + 1);
  const auto undisturbed = bench.make(scene), solver = bench.make(scene);
  undisturbed->load(healthy);
  run_frames(*undisturbed, 5);
  const Particles expected = undisturbed->state().particles;
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  int disturbed = 0, not_counted = 0;
  for (const double bad : {nan, infinity, -infinity, 1e38, -1e38})
    for (const bool in_velocity : {false, true}) {
      Particles sick = healthy;
      sick.ids.insert(sick.ids.begin() + 100, 5000);
      sick.positions.insert(sick.positions.begin() + 100, Eigen::Vector3d(0.3, 0.3, 0.3));
      sick.velocities.insert(sick.velocities.begin() + 100, Eigen::Vector3d::Zero());
      sick.pressures.clear();
      (in_velocity ? sick.velocities : sick.positions)[100].y() = bad;
      solver->load(sick);
      const Course course = run_frames(*solver, 5);
      not_counted += course.lost == 1 && course.active == static_cast<std::int64_t>(healthy.size()) ? 0 : 1;
      Particles now = solver->state().particles;
      if (now.ids.back() == 5000u) {
        now.ids.pop_back();
        now.positions.pop_back();
        now.velocities.pop_back();
        now.pressures.pop_back();
      }
      disturbed += same_bits(now, expected) ? 0 : 1;
    }
  outcome.equal("of 10 sick particles not counted as lost", not_counted, 0.0);
  outcome.equal("of 10 that disturbed another's bits", disturbed, 0.0);
}

/// Speeds no normal number holds: harmless. What it costs is printed, not judged: times differ from run to run.
void denormals(Bench bench, Outcome outcome) {
  std::array<double, 2> milliseconds{};
  for (const bool tiny : {false, true}) {
    Scene scene = with_room_for(stress_tank(k_tank), 512);
    scene.gravity_m_s2.setZero();
    scene.solver.speed_of_sound_m_s = 10.0;
    const auto solver = bench.make(scene);
    // farther apart than H: nothing but their own motion acts on them
    Particles particles = shaken_cube(5, 0.11, {0.02, 0.02, 0.02}, 0.0, 0.0, 1);
    for (auto& v : particles.velocities) v.setConstant(tiny ? 1e-40 : 1e-3);
    Particles inside;
    for (std::size_t i = 0; i < particles.size(); ++i)
      if ((particles.positions[i].array() < k_tank.array() - 0.02).all())
        inside.add(static_cast<std::uint32_t>(inside.size()), particles.positions[i], particles.velocities[i]);
    inside = in_single(inside);
    solver->load(inside);
    run_frames(*solver, 5);
    for (int frame = 0; frame < 40; ++frame) {
      run_frames(*solver, 1);
      milliseconds[tiny ? 1 : 0] += solver->report().frame_ms;
    }
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    if (tiny) outcome.at_most("fastest particle [m/s]", rms_speed(now), 1e-39);
  }
  outcome.information("time of a step, tiny over normal speeds", milliseconds[1] / milliseconds[0]);
}

}  // namespace squall::harness::stress
