#pragma once

#include "backend_opencl/cl.h"

namespace squall::opencl {

/// Sets all arguments of a kernel, in order.
template <class... Arguments>
void set_arguments(cl::Kernel& kernel, const Arguments&... arguments) {
  cl_uint index = 0;
  (kernel.setArg(index++, arguments), ...);
}

}  // namespace squall::opencl
