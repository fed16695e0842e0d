#pragma once

#include <memory>
#include <vector>

#include "core/device_info.h"
#include "core/solver.h"

namespace squall::openmp {

/// The CPU backend: OpenMP threads over rows of cells, SIMD lanes over particles, half as many in double precision. The
/// solver holds no particles yet. Throws DeviceError for an instruction set that this machine lacks.
std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings);

/// The processor; never throws.
std::vector<DeviceInfo> devices();

/// Instruction sets that this machine can run, narrowest first; Simd::scalar is always among them.
std::vector<Simd> available_simd();

}  // namespace squall::openmp
