#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/row.h"
#include "harness/run.h"
#include "harness/validation/case.h"
#include "harness/validation/check.h"
#include "harness/validation/series.h"

namespace squall::harness {

/// What a check said of one run, and whether that is what the case expects.
struct Verdict {
  Finding finding;
  bool expected_to_pass = true;
  std::string reason;  ///< of an expected failure

  /// What could not be measured is no failure that a case may expect.
  bool as_expected() const { return finding.passed == expected_to_pass && !finding.lacks_values; }
};

/// One solver on one backend in a case's scene.
struct CaseRun {
  RunPlan plan;
  Scene scene;  ///< as it ran: scaled, frames as short as samples
  SolverInfo solver;
  std::string error;       ///< why the run ended early: its checks have failed
  bool any_water = false;  ///< there was a particle, at the start or after any sample; else nothing was measured
  bool device_failed = false;
  bool interrupted = false;
  std::int64_t particles = 0;
  double simulated_s = 0.0, wall_s = 0.0, iterations_mean = 0.0;
  std::int64_t steps = 0, clamps = 0;
  std::int64_t unconverged = 0;       ///< solves that ended at max_iterations above their tolerance
  std::vector<std::string> warnings;  ///< of water that is denser than asked for
  TimeSeries series;
  std::vector<Verdict> verdicts;  ///< one per check of the case
};

/// A case and what its runs gave.
struct CaseResult {
  Case what;
  std::vector<CaseRun> runs;
};

/// Makes a solver with the scene's particles loaded.
using SceneSolverFactory = std::function<std::unique_ptr<Solver>(const RunPlan& plan, const Scene& scene)>;

/// Called with the share of the run that is done, in [0, 1]; false ends it.
using CaseProgress = std::function<bool(double share)>;

/// The scene of a case as a run sees it: scaled to about so many particles (absent: as written), with a frame per
/// sample.
Scene scene_of(const Case& what, const std::optional<std::int64_t>& particles);

/// Runs one solver of a case to its end and judges it. Throws InputError for what cannot be set up.
CaseRun run_case(const Case& what, const Scene& scene, RunPlan plan, const SceneSolverFactory& make,
                 const CaseProgress& progress);

/// Whether every verdict of runs that were not interrupted is as expected.
bool all_as_expected(const std::vector<CaseResult>& results);

}  // namespace squall::harness
