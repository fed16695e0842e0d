#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/agree/trajectory.h"

namespace squall::harness {

/// How far two runs are apart in one number that does not follow single particles, beside how far runs are apart that
/// are rounded otherwise in every sub-step: water is chaotic, so every difference grows until only such numbers mean
/// anything.
struct ObservedDistance {
  std::string what;       ///< "front_m": a name of Observation
  double distance = 0.0;  ///< root mean square over the frames
  double floor = 0.0;     ///< the largest such distance between two of the perturbed runs
  bool within() const { return distance <= k_allowance * floor; }

  /// The largest of some 15 distances between 6 like runs is exceeded by one more such run now and then; twice it
  /// hardly ever.
  static constexpr double k_allowance = 2.0;
};

/// Distances of `run` from the first of `ensemble`, whose members were rounded otherwise in every sub-step.
std::vector<ObservedDistance> observed_distances(const Trajectory& run, const std::vector<Trajectory>& ensemble);

/// The state as another rounding might have left it: every coordinate and velocity one place further up or down in
/// single precision, as `seed` and the particle's id decide. Lost particles stay.
State perturbed(const State& state, std::uint64_t seed);

}  // namespace squall::harness
