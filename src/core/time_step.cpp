#include "core/time_step.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/rain.h"
#include "core/scene_keys.h"

namespace squall {

namespace {

using scene_keys::number_text;

/// Explicit viscosity is stable for dt < 2/lambda_max; on a lattice at H = 2dx lambda_max is 15.8 nu/H^2 for Müller's
/// Laplacian, 58.4 nu/H^2 for the central form of wcsph, which acts along the line of centres, and 54.1 nu/H^2 for that
/// of dfsph (docs/physics.md). The rest is for water that is denser than a lattice (docs/stress.md): wcsph's, above
/// all.
double viscous_factor(Pressure pressure) {
  switch (pressure) {
    case Pressure::mueller:
      return 0.1;
    case Pressure::wcsph:
      return 0.025;
    case Pressure::dfsph:
      break;
  }
  return 0.03;
}

/// What alpha of artificial viscosity amounts to: alpha (H/2) c/(2(d + 2)), d = 3 [m^2/s].
double artificial_part(const Scene& scene, Pressure pressure, double alpha) {
  if (pressure != Pressure::wcsph) return 0.0;
  return alpha * 0.5 * scene.support_radius() * scene.speed_of_sound() / 10.0;
}

/// What smoothing of velocities shortens steps like, beside viscosity [m^2/s]: it multiplies the mode that it damps
/// hardest by 1 - xsph dt/dt_max, viscosity its own by 1 - 54 nu dt/H^2, and both act on the same velocities.
double smoothing_part(const Scene& scene, Pressure pressure) {
  if (pressure != Pressure::dfsph) return 0.0;
  const double support = scene.support_radius();
  return scene.solver.xsph * support * support / (54.0 * scene.solver.dt_max_s);
}

double effective_viscosity(const Scene& scene, Pressure pressure) {
  const double physical = scene.fluid.viscosity_m2_s.value_or(0.0);
  // Without viscosity smoothing is stable at every step up to dt_max.
  if (pressure == Pressure::dfsph) return physical > 0.0 ? physical + smoothing_part(scene, pressure) : 0.0;
  return physical + artificial_part(scene, pressure, scene.solver.artificial_viscosity);
}

double signal_speed(const Scene& scene, Pressure pressure) {
  if (pressure == Pressure::dfsph) return 0.0;
  return pressure == Pressure::wcsph ? scene.speed_of_sound() : std::sqrt(scene.solver.stiffness_m2_s2);
}

/// dfsph has no sound to resolve, and a bound of speeds beyond what they turn out to be: with steps longer by this
/// factor errors are the same (docs/dfsph.md).
constexpr double k_spacings_per_cfl = 1.5;

/// Largest time step [s] that sound or, where there is none, motion alone allows.
double courant_limit(const Scene& scene, Pressure pressure, double speed) {
  const double cfl = scene.solver.cfl;
  if (pressure == Pressure::dfsph) return k_spacings_per_cfl * cfl * scene.fluid.spacing_m / speed;
  return cfl * scene.support_radius() / (signal_speed(scene, pressure) + 1.2 * speed);
}

/// Whether any of it falls in the scene's duration.
bool falls(const Scene& scene, const Scene::Rain& rain) {
  return rain.max_particles > 0 && particles_per_second(scene, rain) > 0.0 && rain.start_s < scene.time.duration_s;
}

/// Of the drops that there are, as they are released [m/s].
double rain_speed(const Scene& scene) {
  double fastest = 0.0;
  for (const Scene::Rain& rain : scene.rains) {
    const Eigen::Vector3d fall{0.0, -terminal_speed(rain.drop_diameter_mm), 0.0};
    if (falls(scene, rain)) fastest = std::max(fastest, (fall + rain.wind_m_s).norm());
  }
  return fastest;
}

/// Of what moves within the scene's duration: a block that is held longer does not [m/s].
double start_speed(const Scene& scene) {
  double fastest = 0.0;
  for (const Scene::Block& block : scene.blocks)
    if (!block.held_until_s || *block.held_until_s < scene.time.duration_s)
      fastest = std::max(fastest, block.velocity_m_s.norm());
  for (const Scene::ParticleFile& particle_file : scene.particle_files)
    for (const Eigen::Vector3d& velocity : particle_file.particles.velocities)
      fastest = std::max(fastest, velocity.norm());
  return fastest;
}

std::string digits_text(double value) {
  constexpr int k_digits = 4;
  std::array<char, 32> buffer;
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, k_digits);
  return {buffer.data(), end};
}

/// Four digits, rounded down: what a message says is allowed must be.
std::string at_most_text(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return "0";
  constexpr double k_rounding = 1e-12;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 3.0);
  return digits_text(std::floor(value / unit * (1.0 + k_rounding)) * unit);
}

/// Finds the value to blame for too short a step, and says so.
class Blame {
 public:
  Blame(const Scene& scene, Pressure pressure, double speed)
      : scene_(scene),
        pressure_(pressure),
        speed_(speed),
        shortest_(1.0 / (scene.time.frame_rate_hz * k_max_substeps)),
        limits_(step_limits(scene, pressure, speed)) {}

  std::string text(const std::string& who) const {
    if (limits_.viscous_s <= limits_.courant_s) return viscosity();
    const bool sound_alone = step_limits(scene_, pressure_, 0.0).courant_s < shortest_;
    return sound_alone ? sound() : motion(who);
  }

 private:
  std::string viscosity() const {
    const double support = scene_.support_radius();
    const double most = viscous_factor(pressure_) * support * support / shortest_;
    const double artificial = artificial_part(scene_, pressure_, scene_.solver.artificial_viscosity);
    const double smoothing = smoothing_part(scene_, pressure_);
    const double physical = scene_.fluid.viscosity_m2_s.value_or(0.0);
    const std::string name = "viscosity_m2_s = " + number_text(physical);
    const std::string up_to = "viscosity_m2_s up to " + at_most_text(most - artificial - smoothing);
    if (physical > most) return sentence(name, up_to, "lower viscosity_m2_s", false);
    if (artificial > physical)
      return sentence(
          "artificial_viscosity = " + number_text(scene_.solver.artificial_viscosity) +
              beside("viscosity_m2_s = ", physical, ""),
          "artificial_viscosity up to " + at_most_text((most - physical) / artificial_part(scene_, pressure_, 1.0)),
          "lower artificial_viscosity or speed_of_sound_m_s", false);
    const std::string amounts = ", which counts as " + digits_text(artificial + smoothing) + " m^2/s,";
    if (smoothing > 0.0)
      return sentence(name + beside("xsph = ", scene_.solver.xsph,
                                    " at dt_max_s = " + number_text(scene_.solver.dt_max_s) + amounts),
                      up_to, "lower viscosity_m2_s or xsph, raise dt_max_s", false);
    return sentence(name + beside("artificial_viscosity = ", scene_.solver.artificial_viscosity, amounts), up_to,
                    "lower viscosity_m2_s or artificial_viscosity", false);
  }

  /// What shares a bound with the value to blame; empty where there is none of it.
  static std::string beside(const std::string& name, double value, const std::string& more) {
    return value > 0.0 ? " beside " + name + number_text(value) + more : "";
  }

  /// Sound and motion together may be as fast as this [m/s].
  double fastest() const { return scene_.solver.cfl * scene_.support_radius() / shortest_; }

  std::string sound() const {
    if (pressure_ == Pressure::mueller)
      return sentence("stiffness_m2_s2 = " + number_text(scene_.solver.stiffness_m2_s2),
                      "stiffness_m2_s2 up to " + at_most_text(fastest() * fastest()), "lower stiffness_m2_s2", true);
    const std::string name = "speed_of_sound_m_s";
    const std::string what = scene_.solver.speed_of_sound_m_s
                                 ? name + " = " + number_text(*scene_.solver.speed_of_sound_m_s)
                                 : "a speed of sound of " + digits_text(scene_.speed_of_sound()) +
                                       " m/s (ten times that of a fall through the depth, as " + name + " is not set)";
    return sentence(what, name + " up to " + at_most_text(fastest()),
                    (scene_.solver.speed_of_sound_m_s ? "lower " : "set ") + name, true);
  }

  std::string motion(const std::string& who) const {
    const bool silent = pressure_ == Pressure::dfsph;
    const double most = silent ? k_spacings_per_cfl * scene_.solver.cfl * scene_.fluid.spacing_m / shortest_
                               : (fastest() - signal_speed(scene_, pressure_)) / 1.2;
    const std::string signal = silent ? ""
                                      : (pressure_ == Pressure::wcsph ? " beside a speed of sound of " : " beside ") +
                                            digits_text(signal_speed(scene_, pressure_)) + " m/s" +
                                            (pressure_ == Pressure::wcsph ? "" : ", the root of stiffness_m2_s2,");
    const char* slower = silent                         ? "lower that speed"
                         : pressure_ == Pressure::wcsph ? "lower that speed or speed_of_sound_m_s"
                                                        : "lower that speed or stiffness_m2_s2";
    return sentence(who + " of " + digits_text(speed_) + " m/s" + signal, "up to " + at_most_text(most) + " m/s",
                    slower, true);
  }

  /// `courant`: cfl is part of the bound.
  std::string sentence(const std::string& what, const std::string& most, const std::string& cure, bool courant) const {
    const double cfl = scene_.solver.cfl;
    const bool cautious = courant && cfl < Scene::Solver{}.cfl;
    return what + " needs " + number_text(substeps_needed(scene_, pressure_, speed_)) + " sub-steps per frame, each " +
           digits_text(limits_.smallest()) + " s long; allowed are " + std::to_string(k_max_substeps) + ", that is " +
           most + " with spacing_m = " + number_text(scene_.fluid.spacing_m) + (courant ? ", " : " and ") +
           "frame_rate_hz = " + number_text(scene_.time.frame_rate_hz) +
           (courant ? " and cfl = " + number_text(cfl) : "") + "; " + cure + ", or raise spacing_m" +
           (cautious ? ", cfl" : "") + " or frame_rate_hz";
  }

  const Scene& scene_;
  Pressure pressure_;
  double speed_;
  double shortest_;  ///< s: a frame of k_max_substeps
  StepLimits limits_;
};

}  // namespace

double StepLimits::smallest() const { return std::min(std::min(asked_s, courant_s), viscous_s); }

StepLimits step_limits(const Scene& scene, Pressure pressure, double speed) {
  const double support = scene.support_radius();
  const double viscosity = effective_viscosity(scene, pressure);
  StepLimits limits;
  limits.asked_s = scene.solver.dt_max_s;
  limits.courant_s = courant_limit(scene, pressure, speed);
  limits.viscous_s = viscosity > 0.0 ? viscous_factor(pressure) * support * support / viscosity
                                     : std::numeric_limits<double>::infinity();
  return limits;
}

double time_step_limit(const Scene& scene, Pressure pressure, double speed_bound) {
  return step_limits(scene, pressure, speed_bound).smallest();
}

double substeps_needed(const Scene& scene, Pressure pressure, double speed_bound) {
  constexpr double k_rounding = 1e-9;  // of a step: a limit that divides the frame is one that fits
  const double length = 1.0 / scene.time.frame_rate_hz;
  return std::ceil(length / time_step_limit(scene, pressure, speed_bound) - k_rounding);
}

std::string step_problem(const Scene& scene, Pressure pressure, double speed, const std::string& who) {
  if (substeps_needed(scene, pressure, speed) <= k_max_substeps) return "";
  return Blame(scene, pressure, speed).text(who);
}

std::string step_problem(const Scene& scene, Pressure pressure) {
  const double start = start_speed(scene), rain = rain_speed(scene);
  return step_problem(scene, pressure, std::max(start, rain),
                      rain > start ? "rain with a speed" : "a start at a speed");
}

double smoothing_viscosity(const Scene& scene, Pressure pressure) {
  if (pressure != Pressure::dfsph) return 0.0;
  // eps <r^2>/(6 dt) per application with eps = xsph dt/dt_max; <r^2> = 42/187 H^2 for the bell kernel.
  const double support = scene.support_radius();
  return 7.0 / 187.0 * scene.solver.xsph * support * support / scene.solver.dt_max_s;
}

}  // namespace squall
