#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backend_opencl/device.h"
#include "bench_support/bounds.h"

namespace squall::bench {

/// Measures an OpenCL device, or the part of it that the settings' threads ask for, through OpenCL itself: what its
/// compiler makes of the same arithmetic is part of the bound.
class DeviceProbe {
 public:
  /// lanes: floats per vector, as the solver uses them; seconds: of one run of one probe. Throws DeviceError.
  DeviceProbe(const Settings& settings, int lanes, double seconds);

  Bounds measure(std::size_t working_set_bytes);

 private:
  double rate(Operation operation);
  double bandwidth(std::size_t bytes);
  /// Seconds that the device says the kernel took: the best of a few.
  double best_of(const cl::Kernel& kernel);
  double time(const cl::Kernel& kernel);

  opencl::Machine machine_;
  int lanes_;
  double seconds_;
  std::size_t items_, group_;
  std::vector<cl::Kernel> arithmetic_;  ///< by Operation
  std::vector<cl_int> rounds_;          ///< likewise
  cl::Kernel copy_;
  cl::Buffer from_, to_, sink_;
  std::size_t room_ = 0;  ///< bytes of each buffer of the copy
};

}  // namespace squall::bench
