#pragma once

#include "core/settings.h"

namespace squall::harness {

/// The largest eigenvalues of a pressure solver's forces between particles of an undisturbed, infinite, cubic lattice:
/// what theory says of the time steps that leap-frog can take, dt < 2/omega and dt < 2/lambda.
struct LatticeModes {
  double sound = 0.0;      ///< omega H/c of the fastest wave of density, c = sqrt(k) for mueller; 0 for dfsph
  double viscosity = 0.0;  ///< lambda H^2/nu of the mode that viscosity damps hardest
};

/// For a support ratio H/dx in [1.2, 4]. Waves are searched on a grid of 1/32 of the shortest, in each direction.
LatticeModes lattice_modes(Pressure pressure, double support_ratio);

}  // namespace squall::harness
