#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "core/device_info.h"
#include "harness/run.h"

namespace squall::harness {

/// Asked between two trials; false ends the tuning.
using GoOn = std::function<bool()>;

/// What may be chosen for an OpenCL device without changing a bit of the result.
struct WorkChoice {
  Simd simd = Simd::best;
  WorkSizes work;
  bool operator==(const WorkChoice&) const = default;
};

/// One choice that was measured.
struct Trial {
  WorkChoice choice;
  double ms_per_substep = 0.0;  ///< the least of all counted frames
};

struct Tuning {
  WorkChoice best;
  std::vector<Trial> trials;  ///< in the order they were made; the first is what the device suggests
  bool complete = true;       ///< false: it was ended early
};

/// Measures how fast the plan's scene runs with each of a few choices of work sizes, one after the other, for a few
/// frames each from the scene's start. A choice is taken if it is 2 % faster than the best so far, twice. The plan's
/// own width of vectors, if it names one, stays. At most `limit`, and one trial more; no further once go_on() is false.
/// Throws DeviceError if the device fails with its own suggestion; a choice that it cannot run is passed over.
Tuning tune(const SolverFactory& make, RunPlan plan, const DeviceInfo& device, std::chrono::seconds limit,
            const GoOn& go_on = {});

/// "float8, 8 parts and 1 chunk per unit", "work groups of 128".
std::string to_string(const WorkChoice& choice);

}  // namespace squall::harness
