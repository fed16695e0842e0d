#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/solver.h"
#include "harness/results_json.h"
#include "harness/row.h"

namespace squall::harness {

/// One run of a study, before it is done.
struct StudyRun {
  RunPlan plan;    ///< frames of `scene`
  Scene scene;     ///< as it runs
  int every = 1;   ///< an output time every so many frames: references have shorter frames than points
  int jitter = 0;  ///< 0: starts as the scene says; else the number of a perturbed start
  int repeat = 0;  ///< the same run again, for its time alone
};

/// One run of a study, done: all that the study works with, so that what is kept need not run again.
struct Record {
  std::string key;    ///< of the run
  std::string error;  ///< why its end state is wrong; what follows then ends there
  bool device_failed = false;
  std::string device, simd, state_hash;
  int threads = 0;
  int frames = 0;
  std::int64_t particles = 0, steps = 0;
  double simulated_s = 0.0, wall_s = 0.0, frame_ms_median = 0.0, frame_ms_p95 = 0.0;
  double smallest_dt_s = 0.0;  ///< of all sub-steps
  int most_substeps = 0;       ///< of a frame
  double iterations_mean = 0.0;
  double density_error_max = 0.0;
  std::map<std::string, double> scales;               ///< of the observables
  std::vector<double> time_s;                         ///< output times
  std::map<std::string, std::vector<double>> values;  ///< of each observable at these
  std::vector<std::vector<std::int64_t>> tracks;      ///< at these: x, y, z of some particles [1e-9 dx]
  double energy_gain = 0.0;  ///< largest energy above all that came in, over the energy's scale

  double wall_s_per_s() const { return simulated_s > 0.0 ? wall_s / simulated_s : 0.0; }
  double mean_dt_s() const { return steps > 0 ? simulated_s / static_cast<double>(steps) : 0.0; }
};

/// What tells a run from every other: scene, solver, machine and version of squall.
std::string key_of(const StudyRun& run, const Context& context);

/// The start of a run whose every coordinate is shifted by up to 1e-6 dx, whichever way `number` says.
Particles jittered(Particles particles, double spacing_m, int number);

/// Makes the solver of a run, with the particles of the scene loaded.
using StudySolverFactory = std::function<std::unique_ptr<Solver>(const RunPlan& plan, const Scene& scene)>;

/// Called after every frame with the share done in [0, 1]; false ends the run.
using StudyRunProgress = std::function<bool(double share)>;

/// Carries a run out. Empty if it was ended early. A repeat keeps no series and no tracks. Throws InputError for a
/// scene or plan that is refused.
std::optional<Record> record_run(const StudyRun& run, const std::string& key, const StudySolverFactory& make,
                                 const StudyRunProgress& progress);

Json to_json(const Record& record);
/// Throws InputError for what to_json() did not write.
Record record_from_json(const Json& json);

}  // namespace squall::harness
