#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/workload.h"
#include "backends.h"
#include "harness/agree/agree.h"

namespace squall::app {

/// Subjects of `squall agree` and what was left out, one sentence each.
struct AgreePlans {
  std::vector<harness::Subject> subjects;
  std::vector<std::string> left_out;
};

/// The reference in single precision, which judges; omp with 1, 3 and all threads and with each vector width that this
/// machine has; each OpenCL device, a CPU also with each vector width and number of compute units; or what the options
/// ask for. What was not asked for by name and cannot run is left out with its reason. Throws DeviceError for what was.
AgreePlans plan_agreement(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends);

}  // namespace squall::app
