#pragma once

#include <string>

#include "core/settings.h"

/// What of the machine a run gets.
namespace squall::openmp {

/// As the kernel calls it, "CPU" where it does not.
std::string processor_name();

/// The widest for Simd::best. Throws DeviceError for what this processor cannot run.
Simd choose_simd(Simd wanted);

/// As many as asked for, or all. Throws DeviceError where there is no room for their stacks: OpenMP would end the
/// process.
int choose_threads(int wanted);

}  // namespace squall::openmp
