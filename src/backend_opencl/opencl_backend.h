#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/device_info.h"
#include "core/solver.h"

namespace squall::opencl {

/// A solver on the device that the settings name, without particles yet. Builds the kernels and runs each once.
/// Throws DeviceError if there is no such device (listing those there are), if the scene does not fit into it, if it
/// fails, or if double precision is asked for and it has none.
std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings);

/// Devices of all platforms, in the order that Settings::device counts. Never throws: what goes wrong is said in a
/// device's own `problem` or, if nothing can be listed, in `*problem`.
std::vector<DeviceInfo> devices(std::string* problem);

}  // namespace squall::opencl
