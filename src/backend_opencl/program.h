#pragma once

#include <string>
#include <vector>

#include "backend_opencl/cl.h"

namespace squall::opencl {

/// A kernel file with every #include resolved.
struct KernelSource {
  const char* file;
  std::string text;
};

/// All of kernels/*.cl, as they were when squall was built.
std::vector<KernelSource> embedded_kernels();

/// Builds the sources as one program. Throws DeviceError with the compiler's log.
cl::Program build_program(const cl::Context& context, const cl::Device& device,
                          const std::vector<KernelSource>& sources, const std::string& options);

}  // namespace squall::opencl
