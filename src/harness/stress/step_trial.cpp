#include "harness/stress/largest_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/time_step.h"
#include "harness/measures.h"
#include "harness/stress/bench.h"
#include "harness/stress/lattice_modes.h"

namespace squall::harness {

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_support = 2.0 * k_stress_spacing;  ///< m
constexpr double k_push_m_s = 0.1;                    ///< per component, of still water at the start
constexpr double k_frame_s = 0.01;                    ///< about: of frames of fixed steps

/// Equal to cfl H/c = f H^2/nu: where squall's own bounds of sound and viscosity meet; for dfsph with dt_max.
double meeting_viscosity(Pressure pressure, double signal) {
  Scene probe = stress_pool({4, 4, 4});
  probe.fluid.viscosity_m2_s = 1.0;
  probe.solver.artificial_viscosity = 0.0;
  const double viscous = step_limits(probe, pressure, 0.0).viscous_s;  // of 1 m^2/s
  const double other = pressure == Pressure::dfsph ? probe.solver.dt_max_s : probe.solver.cfl * k_support / signal;
  return viscous / other;
}

Scene with_setting(Scene scene, const StepSetting& setting) {
  if (setting.viscosity_m2_s > 0.0) scene.fluid.viscosity_m2_s = setting.viscosity_m2_s;
  const Pressure pressure = setting.subject.settings.pressure;
  if (pressure == Pressure::wcsph) scene.solver.speed_of_sound_m_s = setting.signal_m_s;
  if (pressure == Pressure::mueller) scene.solver.stiffness_m2_s2 = setting.signal_m_s * setting.signal_m_s;
  return scene;
}

/// As the scene has them, still water pushed about a little.
Particles start_of(const Scene& scene, bool pushed) {
  Particles particles = initial_particles(scene);
  if (!pushed) return particles;
  const Particles pushes = shaken_cube(8, k_stress_spacing, Eigen::Vector3d::Zero(), 0.0, k_push_m_s, 17);
  for (std::size_t i = 0; i < particles.size(); ++i) particles.velocities[i] = pushes.velocities[i % pushes.size()];
  return particles;
}

/// What must hold throughout a run.
class Watch {
 public:
  Watch(const Scene& scene, const StepSetting& setting, const Particles& start, double allowed_gain)
      : scene_(scene), energy_(total_energy(scene, start)), allowed_gain_(allowed_gain) {
    double height = 0.0, speed = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      height += start.positions[i].y();
      speed = std::max(speed, start.velocities[i].norm());
    }
    const double depth = scene.fluid_depth();
    unit_ = scene.particle_mass() * k_stress_gravity * height;
    allowed_speed_ = 2.0 * (std::sqrt(2.0 * k_stress_gravity * depth) + speed);
    allowed_density_ = 0.1;
    if (setting.signal_m_s > 0.0)
      allowed_density_ += 2.0 * k_stress_gravity * depth / (setting.signal_m_s * setting.signal_m_s);
  }

  void see(const Solver& solver, const Particles& now, StepTrial& trial) const {
    const FrameReport& report = solver.report();
    if (!is_finite(now)) return say(trial, "not finite");
    if (report.lost > 0) return say(trial, fmt::format("{} lost", report.lost));
    const double gain = (total_energy(scene_, now) - energy_) / unit_;
    trial.gain = std::max(trial.gain, gain);
    if (!(gain <= allowed_gain_)) return say(trial, fmt::format("energy + {:.3g} %", 100.0 * gain));
    if (!(report.max_speed <= allowed_speed_)) return say(trial, fmt::format("{:.3g} m/s", report.max_speed));
    if (!(report.density_error_mean <= allowed_density_))
      say(trial, fmt::format("{:.3g} % too dense", 100.0 * report.density_error_mean));
  }

 private:
  static void say(StepTrial& trial, std::string trouble) { trial.trouble = std::move(trouble); }

  const Scene& scene_;
  double energy_, allowed_gain_;
  double unit_ = 0.0;  ///< J: the water's potential energy
  double allowed_speed_ = 0.0, allowed_density_ = 0.0;
};

/// One scene of a trial.
void run_scene(Scene scene, bool pushed, const StepSetting& setting, const StressFactory& make, double step_s,
               bool quick, double allowed_gain, const std::function<bool()>& go_on, StepTrial& trial) {
  const double seconds = quick ? 0.1 : 0.5;
  const int steps = quick ? 60 : 300;
  Settings settings = setting.subject.settings;
  settings.fixed_step_s = step_s;
  if (step_s > 0.0) {
    const double per_frame = std::clamp(std::round(k_frame_s / step_s), 1.0, static_cast<double>(k_max_substeps));
    scene.time.frame_rate_hz = 1.0 / (per_frame * step_s);
  } else {
    scene.time.frame_rate_hz = 60.0;
  }
  const auto solver = make(setting.subject.backend, scene, settings);
  solver->load(start_of(scene, pushed));
  const Watch watch(solver->scene(), setting, solver->state().particles, allowed_gain);
  double time = 0.0;
  for (int done = 0; done < steps || time < seconds; time += 1.0 / scene.time.frame_rate_hz) {
    trial.ended = go_on && !go_on();
    if (trial.ended) return;
    const FrameReport& report = solver->advance(Delivery::nothing);
    done += report.substeps;
    trial.longest_s = std::max(trial.longest_s, report.dt_s);
    watch.see(*solver, solver->state().particles, trial);
    if (!trial.trouble.empty()) return;
  }
}

}  // namespace

double StepTheory::smallest() const { return std::min(std::min(sound_s, viscous_s), std::min(force_s, motion_s)); }

const char* StepTheory::smallest_name() const {
  const double least = smallest();
  if (sound_s == least) return "sound";
  if (viscous_s == least) return "viscosity";
  return force_s == least ? "force" : "motion";
}

std::vector<StepSetting> step_settings(const std::vector<StressSubject>& subjects, bool quick) {
  constexpr double k_of_a_scene = 3.5e-3, k_high = 4.0;  // m^2/s
  std::vector<StepSetting> settings;
  for (const auto& subject : subjects) {
    const Pressure pressure = subject.settings.pressure;
    std::vector<double> signals{20.0, 80.0};  // 1 % and 0.06 % of compression under 0.4 m of water
    if (quick) signals = {20.0};
    if (pressure == Pressure::dfsph) signals = {0.0};
    for (const double signal : signals) {
      std::vector<double> viscosities{0.0, k_of_a_scene, meeting_viscosity(pressure, signal), k_high};
      if (quick) viscosities = {k_of_a_scene, k_high};
      for (const double viscosity : viscosities) settings.push_back({subject, signal, viscosity});
    }
  }
  std::stable_sort(settings.begin(), settings.end(), [](const StepSetting& a, const StepSetting& b) {
    const auto key = [](const StepSetting& s) {
      return std::tuple(s.subject.settings.pressure, s.signal_m_s, s.viscosity_m2_s);
    };
    return key(a) < key(b);
  });
  return settings;
}

std::vector<Scene> step_scenes(const StepSetting& setting, bool quick) {
  if (quick)
    return {with_setting(stress_pool({4, 5, 4}), setting),
            with_setting(stress_block({0.5, 0.6, 0.2}, {4, 5, 4}), setting)};
  return {with_setting(stress_pool({6, 8, 6}), setting),
          with_setting(stress_block({0.9, 0.8, 0.3}, {6, 8, 6}), setting)};
}

StepTheory step_theory(const StepSetting& setting, bool quick) {
  const Pressure pressure = setting.subject.settings.pressure;
  const Scene scene = step_scenes(setting, quick).front();
  const LatticeModes modes = lattice_modes(pressure, scene.fluid.support_ratio);
  double viscosity = setting.viscosity_m2_s;
  if (pressure == Pressure::wcsph)  // docs/physics.md
    viscosity += scene.solver.artificial_viscosity * 0.5 * k_support * setting.signal_m_s / 10.0;
  StepTheory theory;
  theory.sound_s = modes.sound > 0.0 ? 2.0 / modes.sound * k_support / setting.signal_m_s : k_infinity;
  theory.viscous_s = viscosity > 0.0 ? 2.0 / modes.viscosity * k_support * k_support / viscosity : k_infinity;
  theory.force_s = 0.25 * std::sqrt(k_stress_spacing / k_stress_gravity);
  theory.motion_s = k_stress_spacing / std::sqrt(2.0 * k_stress_gravity * scene.fluid_depth());
  return theory;
}

StepTrial try_step(const StepSetting& setting, const StressFactory& make, double step_s, bool quick,
                   double allowed_gain, const std::function<bool()>& go_on) {
  StepTrial trial;
  bool pushed = true;
  for (const Scene& scene : step_scenes(setting, quick)) {
    run_scene(scene, pushed, setting, make, step_s, quick, allowed_gain, go_on, trial);
    if (trial.ended || !trial.trouble.empty()) break;
    pushed = false;
  }
  return trial;
}

}  // namespace squall::harness
