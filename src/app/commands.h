#pragma once

#include "app/options.h"

namespace squall::app {

/// Each carries one command out and returns the exit code. Throws InputError, DeviceError and UsageError.
int command_devices(const Options& options);
int command_run(const Options& options);
int command_compare(const Options& options);
int command_sweep(const Options& options);
int command_agree(const Options& options);
int command_study(const Options& options);
int command_validate(const Options& options);
int command_stress(const Options& options);
int command_largest_step(const Options& options);  ///< stress --largest-step

}  // namespace squall::app
