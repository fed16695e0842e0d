#pragma once

#include <string>

#include "core/scene.h"
#include "core/settings.h"

namespace squall {

inline constexpr int k_max_substeps = 1000;  ///< per frame

/// The bounds of a time step [s], each infinite where there is nothing to bound it (docs/physics.md).
struct StepLimits {
  double asked_s = 0.0;    ///< dt_max_s
  double courant_s = 0.0;  ///< motion and, of solvers that have it, sound
  double viscous_s = 0.0;  ///< viscosity, artificial viscosity and smoothing of velocities

  double smallest() const;
};

/// The bounds at a speed [m/s]; those that do not depend on it are the same at every speed.
StepLimits step_limits(const Scene& scene, Pressure pressure, double speed);

/// Largest time step [s] at a speed bound [m/s].
double time_step_limit(const Scene& scene, Pressure pressure, double speed_bound);

/// Sub-steps that a frame needs at a speed bound [m/s], a whole number; infinite where no step is short enough.
double substeps_needed(const Scene& scene, Pressure pressure, double speed_bound);

/// Why a frame in which `who` moves at `speed` [m/s] needs more sub-steps than k_max_substeps, which value is to blame,
/// how large it may be, and what to change; empty if it does not. Names only what the pressure solver has.
std::string step_problem(const Scene& scene, Pressure pressure, double speed, const std::string& who);

/// The same of what is known beforehand: constants of the scene, velocities of the start, and the speed of its rain.
/// What gravity or a moving container may make of them is judged when it has happened (FrameReport).
std::string step_problem(const Scene& scene, Pressure pressure);

/// Viscosity [m^2/s] that dfsph's velocity smoothing ([solver] xsph) amounts to, whatever the time step.
double smoothing_viscosity(const Scene& scene, Pressure pressure);

}  // namespace squall
