#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/solver.h"
#include "harness/measures.h"

namespace squall::harness {

/// A run, remembered by what its frames ended with.
struct Trajectory {
  std::vector<std::uint64_t> hashes;      ///< exact_hash after each frame
  std::vector<Observation> observations;  ///< likewise
  std::vector<Particles> states;          ///< likewise, of the first frames, as many as were asked for
  State middle;                           ///< after the frame that was asked for
  std::int64_t substeps = 0;
  std::string error;  ///< why it ended before its frames: a state that is not finite; empty if it did not
};

/// What to remember beside hashes and observations.
struct Remember {
  int states = 0;  ///< first frames whose particles are kept
  int middle = 0;  ///< frames done when `middle` is taken; 0: where the run starts
};

/// Asked after every frame; false ends the run there.
using EveryFrame = std::function<bool()>;

/// Runs so many frames from where the solver is. Throws DeviceError.
Trajectory follow(Solver& solver, int frames, const Remember& remember, const EveryFrame& go_on);

/// Largest and root mean square distance between two states, in spacings; over particles that both have.
struct Distance {
  double max_dx = 0.0, rms_dx = 0.0;
};
Distance distance_between(const Particles& a, const Particles& b, double spacing);

/// How two runs part over their first frames.
std::vector<Distance> growth_between(const Trajectory& a, const Trajectory& b, double spacing);

/// Index of the first frame with another hash, or that only one of them did; the number of frames if there is none.
std::size_t first_other_frame(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b);

}  // namespace squall::harness
