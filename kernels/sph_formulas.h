/* The physics of squall, once: kernels, pressures, viscosity, walls, drag.

   Everything is dimensionless where it can be. q = r/H with H the support radius; u = max0(1-q), w = max0(1-2q).
   Densities are relative (rho/rho0) and pressures kinematic (p/rho0, m^2/s^2), so rest density appears in none of the
   formulas: mass is rho0 dx^3 exactly. Constant factors (8/(pi H^3), dx^3, ...) are folded into the scales of Params
   (params.h). Sources: Muller, Charypar, Gross 2003 (SCA); Monaghan 1992 (ARAA 30:543), 2005 (Rep. Prog. Phys.
   68:1703); Becker & Teschner 2007 (SCA); wall integrals derived in docs/physics.md. */
#ifndef SQUALL_SPH_FORMULAS_H
#define SQUALL_SPH_FORMULAS_H

#include "shared.h"

SQUALL_NAMESPACE_BEGIN

/* ---- distances ------------------------------------------------------------------------------------------------- */

SQUALL_FORMULA Real squared_length(Real x, Real y, Real z) { return fma(z, z, fma(y, y, x * x)); }

SQUALL_FORMULA Real dot_product(Real ax, Real ay, Real az, Real bx, Real by, Real bz) {
  return fma(az, bz, fma(ay, by, ax * bx));
}

/* max0(1 - r * inverse_length): u for 1/H, w for 2/H. */
SQUALL_FORMULA Real remaining_support(Real r, Real inverse_length) { return max0(nfma(r, inverse_length, (Real)(1))); }

/* ---- smoothing kernels ----------------------------------------------------------------------------------------- */

/* Cubic spline: W = 8/(pi H^3) * cubic_value. Exactly 1 at r = 0 and 0 from r = H on. */
SQUALL_FORMULA Real cubic_value(Real u, Real w) {
  Real uu = u * u;
  return fms(uu + uu, u, w * w * w);
}

/* Cubic spline: dW/dr = -48/(pi H^4) * cubic_slope. */
SQUALL_FORMULA Real cubic_slope(Real u, Real w) { return fms(u, u, w * w); }

/* H^2 - r^2 as one chain; what poly6 is made of is this clamped at zero. */
SQUALL_FORMULA Real squared_support_difference(Real x, Real y, Real z, Real support_squared) {
  return nfma(z, z, nfma(y, y, nfma(x, x, support_squared)));
}
SQUALL_FORMULA Real squared_support_left(Real x, Real y, Real z, Real support_squared) {
  return max0(squared_support_difference(x, y, z, support_squared));
}

/* Poly6: W = 315/(64 pi H^9) * poly6_value(H^2 - r^2). */
SQUALL_FORMULA Real poly6_value(Real t) { return t * t * t; }

/* Poly6: dW/dr = -945/(32 pi H^9) * r * poly6_slope(H^2 - r^2). */
SQUALL_FORMULA Real poly6_slope(Real t) { return t * t; }

/* Spiky: W = 15/(pi H^3) * spiky_value, dW/dr = -45/(pi H^4) * spiky_slope. */
SQUALL_FORMULA Real spiky_value(Real u) { return u * u * u; }
SQUALL_FORMULA Real spiky_slope(Real u) { return u * u; }

/* Bell: W = 315/(8192 pi H^3) * bell_value, dW/dr = -945/(2048 pi H^5) * r * bell_weight, of t = 1 - q^2. The mean of
   poly6, t^3, and t^6, each normalised: as good as the cubic spline at H = 2 dx (docs/dfsph.md), but there is neither a
   root in it nor a division in its gradient. */
SQUALL_FORMULA Real bell_left(Real r2, Real inverse_support_squared) {
  return max0(nfma(r2, inverse_support_squared, (Real)(1)));
}
SQUALL_FORMULA Real bell_value(Real t) {
  Real cube = t * t * t;
  return cube * fma((Real)(143), cube, (Real)(64));
}
SQUALL_FORMULA Real bell_weight(Real t) {
  Real square = t * t;
  return square * fma((Real)(143), square * t, (Real)(32));
}

/* Viscosity kernel: Laplacian = 45/(pi H^5) * viscosity_laplacian, never negative. */
SQUALL_FORMULA Real viscosity_laplacian(Real u) { return u; }

/* ---- pressure -------------------------------------------------------------------------------------------------- */

/* Relative density from a kernel sum and the share of the support that walls fill. */
SQUALL_FORMULA Real relative_density(Real kernel_sum, Real density_scale, Real wall_share) {
  return fma(kernel_sum, density_scale, wall_share);
}

/* p/rho0 of Tait's equation with gamma = 7, clamped at zero; stiffness = c^2/7. */
SQUALL_FORMULA Real tait_pressure(Real density, Real stiffness) {
  Real square = density * density;
  Real fourth = square * square;
  return stiffness * max0(fma(fourth * square, density, -(Real)(1)));
}

/* p/rho0 = k (rho/rho0 - 1). `tension` is 0 to clamp negative pressure away and 1 to keep it. */
SQUALL_FORMULA Real mueller_pressure(Real density, Real stiffness, Real tension) {
  Real p = stiffness * (density - (Real)(1));
  return fma(-tension, max0(-p), max0(p));
}

/* ---- pair forces ------------------------------------------------------------------------------------------------ */

/* wcsph, symmetric in i and j: the factor s of a_i += s (x_i - x_j), without the scale dx^3 48/(pi H^4). Pressure term
   p_i/rho_i^2 + p_j/rho_j^2, plus viscosity that acts along the line of centres (so angular momentum is kept):
   `shear` = viscosity_scale * (-v.x) for physical viscosity, plus artificial_scale * max0(-v.x) (Monaghan 1992).
   pressures = P_i + P_j, volumes = 1/rho_i + 1/rho_j, softening = 0.01 (H/2)^2. One division; 0 at r = 0. */
SQUALL_FORMULA Real wcsph_numerator(Real r2, Real slope, Real pressures, Real volumes, Real shear, Real softening) {
  return fma(pressures, r2 + softening, shear * volumes) * slope;
}
SQUALL_FORMULA Real wcsph_denominator(Real r, Real r2, Real softening, Real tiny) {
  return (r + tiny) * (r2 + softening);
}
SQUALL_FORMULA Real wcsph_pair(Real r, Real r2, Real slope, Real pressures, Real volumes, Real shear, Real softening,
                               Real tiny) {
  return wcsph_numerator(r2, slope, pressures, volumes, shear, softening) / wcsph_denominator(r, r2, softening, tiny);
}

/* mueller pressure: the factor s of f_i += s (x_i - x_j); (p_i + p_j)/(2 rho_j) as p_i V_j + P_j with V = 1/(2 rho),
   P = p V. Half the pressure gradient: Muller's model as printed. */
SQUALL_FORMULA Real mueller_numerator(Real u, Real pressure_i, Real volume_j, Real pressure_volume_j) {
  return fma(pressure_i, volume_j, pressure_volume_j) * spiky_slope(u);
}
SQUALL_FORMULA Real mueller_pair(Real r, Real u, Real pressure_i, Real volume_j, Real pressure_volume_j, Real tiny) {
  return mueller_numerator(u, pressure_i, volume_j, pressure_volume_j) / (r + tiny);
}

/* ---- walls: the share of a particle's support behind a plane at distance q H (docs/physics.md)
   ------------------------ lambda(q) = integral of W over the half space, q >= 0; marginal(q) = -H d
   lambda/d(distance). Exactly 0 from q = 1 on. */

/* Cubic spline; u = max0(1-q), w = max0(1-2q); thirtieth = 1/30, fifth = 1/5. */
SQUALL_FORMULA Real cubic_wall_share(Real u, Real w, Real thirtieth) {
  Real u2 = u * u;
  Real w2 = w * w;
  Real near = u2 * u2 * u * fma(-(Real)(32), u, (Real)(48));
  Real core = w2 * w2 * w * fma(-(Real)(2), w, (Real)(3));
  return (near - core) * thirtieth;
}
SQUALL_FORMULA Real cubic_wall_marginal(Real u, Real w, Real fifth) {
  Real u2 = u * u;
  Real w2 = w * w;
  Real near = u2 * u2 * fma(-(Real)(32), u, (Real)(40)); /* 8 u^4 (1 + 4q) */
  Real core = w2 * w2 * fma(-(Real)(4), w, (Real)(5));   /* w^4 (1 + 8q) */
  return (near - core) * fifth;
}

/* Poly6; u = max0(1-q); two_hundred_fifty_sixth = 1/256 (exact). */
SQUALL_FORMULA Real poly6_wall_share(Real u, Real two_hundred_fifty_sixth) {
  Real u2 = u * u;
  Real polynomial = fma(fma(fma(fma((Real)(35), u, -(Real)(315)), u, (Real)(1080)), u, -(Real)(1680)), u, (Real)(1008));
  return u2 * u2 * u * polynomial * two_hundred_fifty_sixth;
}
SQUALL_FORMULA Real poly6_wall_marginal(Real u, Real two_hundred_fifty_sixth) {
  Real t = u * ((Real)(2) - u); /* 1 - q^2 */
  Real t2 = t * t;
  return (Real)(315) * t2 * t2 * two_hundred_fifty_sixth;
}

/* Spiky; u = max0(1-q); one_half = 1/2. */
SQUALL_FORMULA Real spiky_wall_share(Real u, Real one_half) {
  Real u2 = u * u;
  return u2 * u2 * u * fma(-(Real)(2), u, (Real)(3)) * one_half;
}
SQUALL_FORMULA Real spiky_wall_marginal(Real u, Real one_half) {
  Real u2 = u * u;
  return (Real)(3) * u2 * u2 * fma(-(Real)(4), u, (Real)(5)) * one_half;
}

/* Bell; u = max0(1-q); two_hundred_fifty_sixth = 1/256 (exact). With t = 1 - q^2 the marginal is the mean of 315/256
   t^4 and 6435/4096 t^7, and with every further power of t the share loses a multiple of q t^n. */
SQUALL_FORMULA Real bell_wall_share(Real u, Real two_hundred_fifty_sixth) {
  Real q = (Real)(1) - u;
  Real t = u * ((Real)(2) - u);
  Real t2 = t * t;
  Real lost = q * t2 * t2 * t * fma(fma((Real)(429), t, (Real)(462)), t, (Real)(504));
  Real scale = (Real)(8) * two_hundred_fifty_sixth * two_hundred_fifty_sixth; /* 1/8192 */
  return nfma(scale, lost, poly6_wall_share(u, two_hundred_fifty_sixth));
}
SQUALL_FORMULA Real bell_wall_marginal(Real u, Real two_hundred_fifty_sixth) {
  Real t = u * ((Real)(2) - u);
  Real t2 = t * t;
  Real scale = (Real)(8) * two_hundred_fifty_sixth * two_hundred_fifty_sixth; /* 1/8192 */
  return scale * (t2 * t2) * fma((Real)(6435), t2 * t, (Real)(5040));
}

/* ---- time integration -------------------------------------------------------------------------------------------- */

/* Acceleration by air of a drop at velocity v relative to the wind (one component at a time): coefficient = g/v_t^2
   makes v_t the terminal speed (Gunn & Kinzer 1949 through Atlas 1973); `weight` is 1 for a drop alone and 0 in the
   water. */
SQUALL_FORMULA Real drag_rate(Real vx, Real vy, Real vz, Real coefficient, Real weight) {
  return -(weight * coefficient * sqrt(squared_length(vx, vy, vz)));
}

/* 1 for a particle whose relative density has nothing but its own share, 0 for any other. The kernel sum next above
   `self_value` differs from it by one part in 2^23, which `steepness` (2^30) carries past the clamp. */
SQUALL_FORMULA Real isolation(Real kernel_sum, Real self_value, Real density_scale, Real wall_share, Real steepness) {
  Real others = fma(kernel_sum - self_value, density_scale, wall_share);
  return max0(nfma(steepness, others, (Real)(1)));
}

SQUALL_NAMESPACE_END

#endif
