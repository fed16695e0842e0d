#pragma once

#include "backend_opencl/device.h"

namespace squall::opencl {

/// True if the device writes right into host memory: asks it to, and looks. What the driver says about unified memory
/// is no proof.
bool shares_host_memory(Machine& machine, const cl::Program& program);

}  // namespace squall::opencl
