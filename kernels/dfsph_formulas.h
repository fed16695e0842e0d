/* dfsph: the incompressible pressure solve (Bender & Koschier 2015, SCA; 2017, TVCG 23:1193), as docs/dfsph.md derives
   it. Unknown is one impulse j_i >= 0 per particle, j = k dt with k = p/rho0 [m^2/s]. With -G_ij = -V grad_i W_ij =
   force_scale weight_ij (x_i - x_j), the gradient e_i of the open share of the support, and the direction h_i in which
   a particle's own density falls fastest,

     descent   h_i = sum_j (-G_ij) + e_i
     velocity  v_i += sum_j j_j (-G_ij) + j_i h_i
     rate      D_i  = sum_j v_j.(-G_ij) - v_i.h_i               (d rho/dt, relative; the adjoint)
     lack      s_i  = room_i - dt D_i >= 0   wherever j_i > 0 only s_i = 0

   A backend may keep the weight of a pair or compute it again, the bits are the same. Sums over pairs are one chain
   each, in canonical order. */
#ifndef SQUALL_DFSPH_FORMULAS_H
#define SQUALL_DFSPH_FORMULAS_H

#include "sph_formulas.h"

SQUALL_NAMESPACE_BEGIN

/* min(a, b): exactly a where a <= b. */
SQUALL_FORMULA Real no_more_than(Real a, Real b) { return a - max0(a - b); }

/* ---- pairs ------------------------------------------------------------------------------------------------------ */

/* A sum of |G_ij|^2 without the scale, and a pair's. */
SQUALL_FORMULA Real plus_squared_slope(Real sum, Real weight, Real r2) { return fma(weight * r2, weight, sum); }

/* Of a pair when pressure and viscosity act at once: the factor of -G_ij. Viscosity acts along the line of centres (as
   Monaghan 2005; the weight is docs/dfsph.md's); impulse = j_j, viscous = 187/7 nu/H^2 kick, receding = v_ij.x_ij. */
SQUALL_FORMULA Real viscous_pair_push(Real impulse, Real viscous, Real receding) {
  return nfma(viscous, receding, impulse);
}

/* ---- particles: before the solve ----------------------------------------------------------------------------------
 */

/* - d D_i/d j_i = |h_i|^2 + sum_j |G_ij|^2 [1/m^2]; squares = sum of plus_squared_slope. */
SQUALL_FORMULA Real pressure_response(Real x, Real y, Real z, Real squares, Real force_scale) {
  return fma(force_scale * force_scale, squares, squared_length(x, y, z));
}

/* 1/response, and 0 where there is next to none: response/(response^2 + guard). */
SQUALL_FORMULA Real inverse_response(Real response, Real guard) { return response / fma(response, response, guard); }

/* D from the sum of weight v_j.(x_i - x_j) and from v.h. */
SQUALL_FORMULA Real compression_rate(Real approaching_sum, Real force_scale, Real along_descent) {
  return fms(force_scale, approaching_sum, along_descent);
}

/* Room of the density solve: what may still be compressed, or the share `correction` of what is compressed too much.
   Correction is speed and speed stays, so a start that is over-dense altogether must not be corrected at once. */
SQUALL_FORMULA Real density_room(Real density, Real correction) {
  Real excess = density - (Real)(1);
  return nfma(correction, max0(excess), max0(-excess));
}

/* Room of the divergence solve: none, but for particles that have little water around them. */
SQUALL_FORMULA Real divergence_room(Real density, Real free_density) { return max0(free_density - density); }

/* ---- particles: an iteration ---------------------------------------------------------------------------------------
 */

SQUALL_FORMULA Real lack_of_compression(Real room, Real dt, Real rate) { return nfma(dt, rate, room); }

/* Jacobi step, projected: relaxation_rate = relaxation/dt. */
SQUALL_FORMULA Real projected_impulse(Real impulse, Real lack, Real relaxation_rate, Real inverse) {
  return max0(nfma(relaxation_rate * inverse, lack, impulse));
}

/* Nesterov's step beyond it. */
SQUALL_FORMULA Real extrapolated_impulse(Real projected, Real projected_before, Real momentum) {
  return max0(fma(momentum, projected - projected_before, projected));
}

/* How far a particle is from s >= 0, j >= 0, s j = 0, as a relative density: compression left over, or expansion as far
   as it is its own pressure's doing. Not counted where pressure has no effect. */
SQUALL_FORMULA Real solve_error(Real lack, Real impulse, Real dt, Real response, Real inverse) {
  Real expansion = no_more_than(max0(lack), impulse * dt * response);
  return (max0(-lack) + expansion) * (response * inverse);
}

/* The impulse to start from: of the last pressure, but not beyond what moves water by a spacing. */
SQUALL_FORMULA Real warm_impulse(Real pressure, Real warm_kick, Real largest) {
  return no_more_than(pressure * warm_kick, largest);
}

SQUALL_NAMESPACE_END

#endif
