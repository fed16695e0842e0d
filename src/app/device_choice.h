#pragma once

#include <string>
#include <vector>

#include "app/device_choice.h"
#include "app/options.h"
#include "backends.h"
#include "harness/row.h"

/// Which backends, devices and precisions a command line means, and what cannot run.
namespace squall::app {

/// Throws DeviceError for a name that this build does not know.
const BackendInfo& find_backend(const std::vector<BackendInfo>& backends, const std::string& name);

/// Why nothing of a backend can run; empty if something can.
std::string problem_of(const BackendInfo& backend);

/// Devices with this index or part of the name; all for an empty text. Throws DeviceError if there is none.
std::vector<DeviceInfo> select_devices(const BackendInfo& backend, const std::string& text);

/// Why a device cannot run in a precision; empty if it can.
std::string problem_in(const DeviceInfo& device, Precision precision);

/// Whether runs on it must give the bits of the others.
bool promises_bits(const DeviceInfo& device, Precision precision);

/// As asked for; else reference is the yardstick in double, and the others are fast.
Precision precision_of(const Options& options, const std::string& backend);

/// The device that a plan runs on. Throws DeviceError if it is not there.
const DeviceInfo& device_of(const harness::RunPlan& plan, const std::vector<BackendInfo>& backends);

}  // namespace squall::app
