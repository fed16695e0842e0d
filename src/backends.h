#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/device_info.h"
#include "core/solver.h"

namespace squall {

/// A backend, built in or left out.
struct BackendInfo {
  std::string name;
  bool built = false;
  std::string problem;  ///< why it was left out or cannot run here; empty if it can
  std::vector<DeviceInfo> devices;
};

/// Every backend this source tree knows, in a fixed order: reference, omp, opencl. Loads OpenCL drivers.
std::vector<BackendInfo> list_backends();

/// A solver for the scene with the particles it starts from already loaded. Throws InputError for an unknown or
/// left-out backend, DeviceError if the device cannot run, with the likely causes.
std::unique_ptr<Solver> make_solver(const std::string& backend, const Scene& scene, const Settings& settings);

}  // namespace squall
