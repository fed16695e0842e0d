#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/workload.h"
#include "backends.h"
#include "harness/row.h"

namespace squall::app {

/// Plans and what was left out of them, one sentence each.
struct Plans {
  std::vector<harness::RunPlan> plans;
  std::vector<std::string> left_out;
};

/// The one plan of `squall run`. Throws UsageError for options that contradict each other and DeviceError, with the
/// likely causes, if the backend or device asked for cannot run.
harness::RunPlan plan_run(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends);

/// The plans of `squall compare`: omp with 1 and with all threads, each OpenCL device with every read-back mode, or
/// what the options ask for. What was not asked for by name and cannot run is left out with its reason. Throws like
/// plan_run.
Plans plan_comparison(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends);

/// The plans of `squall sweep`: omp with 1, 2, 4, ... and all threads, each OpenCL device with the read-back that
/// should suit it best, or what the options ask for; 30 frames unless they ask for others. Throws like plan_run.
Plans plan_sweep(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends);

/// The plans of `squall validate` for one pressure solver: the backends asked for, else the first of omp, opencl and
/// reference that has it. What was asked for by name and does not have this solver is left out with its reason; a
/// backend that cannot run at all throws DeviceError.
Plans plan_validation(const Options& options, Pressure pressure, const std::vector<BackendInfo>& backends);

/// The subjects of `squall stress`: omp with all threads and each OpenCL device, or what the options ask for, each with
/// every pressure solver that it has, or the one asked for. Throws like plan_run.
Plans plan_stress(const Options& options, const std::vector<BackendInfo>& backends);

}  // namespace squall::app
