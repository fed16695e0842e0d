#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/solver.h"

namespace squall::harness {

/// A state that single sub-steps start from.
struct StartState {
  std::string name;  ///< "at the start"
  State state;
};

/// What one sub-step found out and did.
struct OneStep {
  Particles after;
  Fields fields;                        ///< of the first fields.densities.size() of `after`
  std::vector<Eigen::Vector3d> forces;  ///< likewise: change of velocity per kick [m/s^2]
  std::int64_t clamps = 0, active = 0, lost = 0;
};

/// Restores the state and does one sub-step. Throws DeviceError.
OneStep take_one_step(Solver& solver, const State& start);

/// Integers of a sub-step, which rounding has no part in once the start is the same.
struct IntegerCheck {
  bool same_order = true;
  std::int64_t neighbours_differ = 0;           ///< particles with another count
  bool same_counts = true;                      ///< clamped, active and lost ones
  std::optional<std::uint32_t> first_particle;  ///< lowest place in the order that differs, by its id

  bool exact() const { return same_order && neighbours_differ == 0 && same_counts; }
};
IntegerCheck check_integers(const OneStep& expected, const OneStep& step);

/// Distance of a field from the double reference, in units in the last place of a single-precision number as large as
/// the field's largest magnitude.
struct Ulps {
  double max = 0.0, rms = 0.0;
};
struct StepErrors {
  Ulps density, pressure, force;
  std::int64_t neighbours_differ = 0;  ///< distances within rounding of H may fall on either side of it
};
/// `reference` is a step in double precision from the same state. Particles are matched by id.
StepErrors step_errors(const OneStep& reference, const OneStep& step);

/// The state with every velocity 0: after one step from it, velocities hold the force alone, to all its digits.
State stilled(const State& state);

}  // namespace squall::harness
