#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/errors.h"
#include "core/frame_plan.h"
#include "harness/measures.h"
#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

Scene pool_with_step(double dt) {
  Scene scene = stress_pool({6, 8, 6});
  scene.solver.cfl = 100.0;  // no limit but dt_max
  const double frames_per_s = std::min(1000.0, 1.0 / dt);
  scene.time.frame_rate_hz = frames_per_s;
  const double steps = std::max(1.0, std::floor(1.0 / (frames_per_s * dt)));
  scene.solver.dt_max_s = 1.0 / (frames_per_s * steps);
  return scene;
}

/// A pool set down at rest stays one: after 300 steps it moves no faster than if it had fallen a tenth of its depth. It
/// rings a little, since it starts uncompressed; what is unstable grows beyond all bounds.
bool is_stable(Bench bench, const Scene& scene) {
  const auto solver = bench.make(scene);
  const double depth = scene.fluid_depth();
  for (int step = 0; step < 300;) {
    const Course course = run_frames(*solver, 1);
    step += static_cast<int>(course.substeps);
    if (course.lost > 0) return false;
  }
  const Particles now = solver->state().particles;
  const double bound = 0.1 * scene.particle_mass() * static_cast<double>(now.size()) * k_stress_gravity * depth;
  return is_finite(now) && kinetic_j(scene, now) <= bound;
}

/// The largest stable step [s] between `low` (stable) and `high`, to 2 %.
template <class Stable>
double bisect(double low, double high, const Stable& stable) {
  while (high > 1.02 * low) {
    const double middle = std::sqrt(low * high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

std::string short_text(double value) {
  const std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2);
}

}  // namespace

/// The largest step at which a pool rests, found by bisection, beside H/c (Courant, Friedrichs, Lewy). What the time
/// step is planned as must lie below it.
void largest_step(Bench bench, Outcome outcome) {
  for (const double factor : {1.0, 4.0}) {
    Scene probe = pool_with_step(1e-3);
    const double sound = factor * 20.0;
    probe.solver.speed_of_sound_m_s = sound;
    probe.solver.stiffness_m2_s2 = sound * sound;
    const double theory = probe.support_radius() / sound;
    const auto stable = [&](double dt) {
      Scene scene = pool_with_step(dt);
      scene.solver.speed_of_sound_m_s = sound;
      scene.solver.stiffness_m2_s2 = sound * sound;
      return is_stable(bench, scene);
    };
    const std::string name = "c = " + short_text(sound) + " m/s: largest stable step";
    if (bench.pressure() == Pressure::dfsph) {
      // no sound: the step is what water may move in it
      outcome.at_least(name + " [of dt_max]", bisect(1e-3, 0.02, stable) / 0.005, 1.0);
      return;
    }
    const double largest = bisect(0.1 * theory, 4.0 * theory, stable);
    outcome.information(name + " [of H/c]", largest / theory);
    Scene scene = stress_pool({6, 8, 6});
    scene.solver.speed_of_sound_m_s = sound;
    scene.solver.stiffness_m2_s2 = sound * sound;
    const double taken = time_step_limit(scene, bench.pressure(), std::sqrt(2.0 * k_stress_gravity * 0.4));
    outcome.at_most("c = " + short_text(sound) + " m/s: step that is taken [of the largest stable]", taken / largest,
                    1.0);
  }
}

/// A dt_max twenty times too long, and a frame of a whole second: sub-steps keep the water what it is.
void oversized_steps(Bench bench, Outcome outcome) {
  for (const double rate : {60.0, 1.0}) {
    Scene scene = stress_block({0.8, 0.8, 0.4}, {5, 10, 8});
    scene.time.frame_rate_hz = rate;
    scene.solver.dt_max_s = 1.0;
    const auto solver = bench.make(scene);
    const double start = total_energy(scene, solver->state().particles);
    const Course course = run_seconds(*solver, 1.0);
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    const std::string frames = rate > 1.0 ? "dt_max = 1 s: " : "a frame of 1 s: ";
    outcome.at_most(frames + "energy after a second [of the start's]", total_energy(scene, now) / start, 1.001);
    outcome.equal(frames + "frames whose step was too long", static_cast<double>(course.limited_frames), 0.0);
  }
}

/// A stiffness of 1e5 m^2/s^2 with the time step that one of 3 m^2/s^2 could take.
void stiff_with_soft_step(Bench bench, Outcome outcome) {
  if (bench.pressure() != Pressure::mueller) {
    outcome.not_applicable = "stiffness is mueller's";
    return;
  }
  Scene soft = stress_pool({6, 6, 6});
  soft.solver.stiffness_m2_s2 = 3.0;
  soft.solver.dt_max_s = 1.0;
  Scene scene = stress_pool({6, 6, 6});
  scene.solver.stiffness_m2_s2 = 1e5;
  scene.solver.dt_max_s = time_step_limit(soft, bench.pressure(), 0.0);
  scene.time.frame_rate_hz = 100.0;
  const auto solver = bench.make(scene);
  const double start = total_energy(scene, solver->state().particles);
  const Course course = run_seconds(*solver, 0.3);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.information("sub-steps taken", static_cast<double>(course.substeps));
  outcome.at_most("energy [of the start's]", total_energy(scene, now) / start, 1.001);
}

/// Hardly any viscosity, and that of pitch: random motion dies down, at no time step does it grow.
void extreme_viscosity(Bench bench, Outcome outcome) {
  for (const double viscosity : {1e-6, 100.0}) {
    Scene scene = with_room_for(stress_tank({2.0, 2.0, 2.0}), 512);
    scene.gravity_m_s2.setZero();
    scene.fluid.viscosity_m2_s = viscosity;
    scene.solver.speed_of_sound_m_s = 10.0;
    const auto solver = bench.make(scene);
    const Particles start = shaken_cube(8, k_stress_spacing, {0.8, 0.8, 0.8}, 0.0, 0.1, 17);
    solver->load(start);
    double highest = 0.0;
    std::int64_t limited = 0;
    for (int frame = 0; frame < (bench.quick() ? 10 : 50); ++frame) {
      limited += run_frames(*solver, 1).limited_frames;
      highest = std::max(highest, rms_speed(solver->state().particles) / rms_speed(start));
    }
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    const std::string of = viscosity < 1.0 ? "1e-6 m^2/s: " : "100 m^2/s: ";
    outcome.at_most(of + "highest mean speed [of the start's]", highest, 1.001);
    outcome.equal(of + "frames whose step was too long", static_cast<double>(limited), 0.0);
    if (viscosity > 1.0)
      outcome.at_most(of + "mean speed at the end [of the start's]", rms_speed(now) / rms_speed(start), 0.1);
  }
}

/// One or two iterations, and a tolerance that nothing meets: residuals are reported, nothing explodes.
void few_iterations(Bench bench, Outcome outcome) {
  if (bench.pressure() != Pressure::dfsph) {
    outcome.not_applicable = "nothing is iterated";
    return;
  }
  for (const int most : {1, 2}) {
    Scene scene = stress_block({0.8, 0.8, 0.4}, {5, 8, 8});
    scene.time.frame_rate_hz = 100.0;
    scene.solver.max_iterations = most;
    scene.solver.density_tolerance = scene.solver.divergence_tolerance = 1e-7;
    const auto solver = bench.make(scene);
    const double start = total_energy(scene, solver->state().particles);
    const Course course = run_seconds(*solver, 0.3);
    const Particles now = solver->state().particles;
    expect_sound(*solver, now, outcome);
    const std::string with = std::to_string(most) + (most == 1 ? " iteration: " : " iterations: ");
    outcome.at_most(with + "energy [of the start's]", total_energy(scene, now) / start, 1.001);
    outcome.at_least(with + "solves reported as cut short", static_cast<double>(course.unconverged), 1.0);
  }
  for (const double tolerance : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Scene scene = stress_pool({3, 3, 3});
    scene.solver.density_tolerance = tolerance;
    bool refused = false;
    try {
      bench.make(scene);
    } catch (const InputError&) {
      refused = true;
    }
    outcome.equal("tolerance " + std::to_string(tolerance) + " is refused", refused ? 1.0 : 0.0, 1.0);
  }
}

/// The step becomes ten times shorter, and ten times longer, from one frame to the next: warm starts do not depend on
/// it.
void abrupt_steps(Bench bench, Outcome outcome) {
  if (bench.pressure() != Pressure::dfsph) {
    outcome.not_applicable = "there is no warm start";
    return;
  }
  Scene fine = stress_pool({6, 8, 6}), coarse = fine;
  fine.time.frame_rate_hz = coarse.time.frame_rate_hz = 100.0;
  fine.solver.dt_max_s = 1e-4;
  coarse.solver.dt_max_s = 1e-3;
  State state;
  double worst = 0.0;
  for (const Scene* scene : {&coarse, &fine, &coarse}) {
    const auto solver = bench.make(*scene);
    if (scene != &coarse || state.particles.size() > 0) {
      state.clock.previous_substeps = 0;  // n may fall at once
      solver->restore(state);
    }
    const Particles before = solver->state().particles;
    run_frames(*solver, state.particles.size() > 0 ? 1 : 50);
    const double change = total_energy(*scene, solver->state().particles) / total_energy(*scene, before) - 1.0;
    if (state.particles.size() > 0) worst = std::max(worst, std::abs(change));
    state = solver->state();
    expect_sound(*solver, state.particles, outcome);
  }
  outcome.at_most("change of energy in the frame after [of the start's]", worst, 1e-3);
}

/// A scene has one density: fluids of 1:1000 cannot be written down, and a density beyond any liquid's is refused.
void extreme_densities(Bench bench, Outcome outcome) {
  for (const double density : {1e-3, 1e8}) {
    Scene scene = stress_pool({3, 3, 3});
    scene.fluid.rest_density_kg_m3 = density;
    bool refused = false;
    try {
      bench.make(scene);
    } catch (const InputError&) {
      refused = true;
    }
    outcome.equal((density < 1.0 ? "1e-3" : "1e8") + std::string(" kg/m^3 is refused"), refused ? 1.0 : 0.0, 1.0);
  }
  Particles end[2];
  for (const bool heavy : {false, true}) {
    Scene scene = stress_pool({4, 4, 4});
    scene.fluid.rest_density_kg_m3 = heavy ? 1e5 : 1.0;
    const auto solver = bench.make(scene);
    run_frames(*solver, 20);
    end[heavy ? 1 : 0] = solver->state().particles;
  }
  outcome.equal("1 and 1e5 kg/m^3 move alike, to the bit", same_bits(end[0], end[1]) ? 1.0 : 0.0, 1.0);
}

}  // namespace squall::harness::stress
