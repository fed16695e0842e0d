#pragma once

#include "core/settings.h"
#include "params.h"

namespace squall {

/// The smoothing kernel that a pressure solver sums densities with: SQUALL_CUBIC, ... (kernels/params.h).
constexpr int density_kernel(Pressure pressure) {
  switch (pressure) {
    case Pressure::mueller:
      return SQUALL_POLY6;
    case Pressure::wcsph:
      return SQUALL_CUBIC;
    case Pressure::dfsph:
      break;
  }
  return SQUALL_BELL;
}

/// The one whose gradient its pressure takes. Only mueller's is another (Muller, Charypar, Gross 2003).
constexpr int force_kernel(Pressure pressure) {
  return pressure == Pressure::mueller ? SQUALL_SPIKY : density_kernel(pressure);
}

}  // namespace squall
