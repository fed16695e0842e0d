#pragma once

#include <string>
#include <utility>

#include "backend_opencl/cl.h"
#include "core/errors.h"

namespace squall::opencl {

/// The name of an OpenCL error code, as in the specification.
std::string error_name(cl_int code);

/// "clEnqueueNDRangeKernel failed with CL_OUT_OF_RESOURCES (-5) on <device>: <likely cause>".
DeviceError device_error(const cl::Error& error, const std::string& device);

/// Runs a function; an OpenCL failure leaves it as a DeviceError.
template <class Function>
decltype(auto) translate_errors(const std::string& device, Function&& function) {
  try {
    return std::forward<Function>(function)();
  } catch (const cl::Error& error) {
    throw device_error(error, device);
  }
}

}  // namespace squall::opencl
