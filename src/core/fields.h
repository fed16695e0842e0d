#pragma once

#include <vector>

namespace squall {

/// What the last sub-step found out about its active particles before it moved them: element i belongs to particle i of
/// Solver::state(), which has the active ones first. Doubles hold single-precision values exactly.
struct Fields {
  std::vector<double> densities;  ///< relative to rest density
  std::vector<double> pressures;  ///< p/rho0 [m^2/s^2]; from the device's own p/rho^2 to 3 roundings, dfsph's exactly
  std::vector<int> neighbours;    ///< within H, without self; empty without Settings::statistics
};

}  // namespace squall
