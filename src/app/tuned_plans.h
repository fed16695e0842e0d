#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/workload.h"
#include "backends.h"
#include "harness/tuning.h"

namespace squall::app {

/// Gives the plans of the opencl backend the work sizes that are known to be fast on their device: measured now with
/// --tune (and remembered), else from the tuning table, else none. Returns what was chosen, a sentence per device; one
/// that fails while it is tuned gets a sentence, too. Once go_on() is false, nothing is measured or remembered any
/// more.
std::vector<std::string> apply_tuning(const Options& options, const Workload& workload,
                                      const std::vector<BackendInfo>& backends, const harness::SolverFactory& make,
                                      std::vector<harness::RunPlan>& plans, const harness::GoOn& go_on);

}  // namespace squall::app
