#pragma once

#include <optional>
#include <string>

#include "core/device_info.h"

namespace squall::harness {

/// Where and with what a result was measured.
struct Context {
  std::string squall_version;
  std::string git_revision;
  std::string date;  ///< ISO 8601, UTC
  std::string host;
  std::string cpu;
  int cores = 0;    ///< physical ones this machine has
  int threads = 0;  ///< hardware threads
  std::string compiler;
  std::string flags;
  std::optional<DeviceInfo> opencl;  ///< the first OpenCL device that took part
  std::string opencl_build_options;  ///< of its kernels
};

/// Asks the build and the machine. Unknown texts are empty.
Context collect_context();

}  // namespace squall::harness
