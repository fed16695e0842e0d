#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backend_opencl/cl.h"
#include "core/device_info.h"
#include "core/settings.h"

namespace squall::opencl {

struct FoundDevice {
  cl::Device device;
  DeviceInfo info;
};

/// Devices of all platforms, in order. Never throws; `*problem` says why there are none.
std::vector<FoundDevice> find_devices(std::string* problem);

/// Index of the device that `wanted` means: empty the first, digits an index, else part of a name in either case.
/// Throws DeviceError that lists what there is, if it means none or one that cannot run.
std::size_t choose_device(const std::vector<DeviceInfo>& devices, const std::string& wanted,
                          const std::string& problem);

/// Throws DeviceError if the device lacks what a precision needs.
void check_precision(const DeviceInfo& device, Precision precision);

/// A device opened for one solver: a context and an in-order queue of its own.
struct Machine {
  DeviceInfo info;
  cl::Device device;  ///< the device, or the part of it that the settings' threads ask for
  cl::Context context;
  cl::CommandQueue queue;
  int compute_units = 0;  ///< used
  bool is_cpu = false;
  bool rounds_correctly = false;  ///< divide and square root
};

/// Throws DeviceError.
Machine open_machine(const Settings& settings);

/// Memory that a solver will ask the device for.
struct MemoryNeed {
  const char* what;
  std::size_t bytes;
  bool constant = false;  ///< in the constant address space
};

/// Whether the device can hold each of them, and all together.
bool fits(const Machine& machine, const std::vector<MemoryNeed>& needs);

/// Throws DeviceError with need and limit if the device cannot hold one of them, or all together.
void check_limits(const Machine& machine, const std::vector<MemoryNeed>& needs);

}  // namespace squall::opencl
