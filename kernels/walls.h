/* Walls without boundary particles: what share of a particle's support lies behind the container's faces and inside
   solid boxes, and its gradient, in closed form (docs/physics.md). The fluid's own region is an intersection, so the
   open shares (1 - share) multiply. A wall further than H away gives exactly 1 and gradient 0: skipping it, or
   evaluating it, is the same to the last bit. */
#ifndef SQUALL_WALLS_H
#define SQUALL_WALLS_H

#include "params.h"
#include "sph_formulas.h"

SQUALL_NAMESPACE_BEGIN

/* Share of the support beyond a plane, the plane `q` support radii away (q >= 0). */
SQUALL_PARAMS_FORMULA Real wall_share(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape, Real q) {
  Real u = max0((Real)(1) - q);
  if (kernel_shape == SQUALL_POLY6) return poly6_wall_share(u, (Real)(p->two_hundred_fifty_sixth));
  if (kernel_shape == SQUALL_SPIKY) return spiky_wall_share(u, (Real)(p->one_half));
  if (kernel_shape == SQUALL_BELL) return bell_wall_share(u, (Real)(p->two_hundred_fifty_sixth));
  return cubic_wall_share(u, max0((Real)(1) - (q + q)), (Real)(p->thirtieth));
}

SQUALL_PARAMS_FORMULA Real wall_marginal(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape, Real q) {
  Real u = max0((Real)(1) - q);
  if (kernel_shape == SQUALL_POLY6) return poly6_wall_marginal(u, (Real)(p->two_hundred_fifty_sixth));
  if (kernel_shape == SQUALL_SPIKY) return spiky_wall_marginal(u, (Real)(p->one_half));
  if (kernel_shape == SQUALL_BELL) return bell_wall_marginal(u, (Real)(p->two_hundred_fifty_sixth));
  return cubic_wall_marginal(u, max0((Real)(1) - (q + q)), (Real)(p->fifth));
}

/* Two opposite faces of the container: open share between them and its derivative along the axis. */
SQUALL_PARAMS_FORMULA Real axis_opening(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape, Real coordinate,
                                        Real size, Real shift, Real high_weight, Real* slope) {
  Real inverse_support = (Real)(p->inverse_support);
  Real low_q = max0((coordinate + shift) * inverse_support);
  Real high_q = max0((size - coordinate + shift) * inverse_support);
  Real low_open = (Real)(1) - wall_share(p, kernel_shape, low_q);
  Real high_open = (Real)(1) - high_weight * wall_share(p, kernel_shape, high_q);
  Real low_slope = wall_marginal(p, kernel_shape, low_q) * inverse_support;
  Real high_slope = high_weight * wall_marginal(p, kernel_shape, high_q) * inverse_support;
  *slope = fma(low_slope, high_open, -(high_slope * low_open));
  return low_open * high_open;
}

/* Open share of the container at (x, y, z) and its gradient (1/m). */
SQUALL_PARAMS_FORMULA Real container_opening(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape, Real shift,
                                             Real x, Real y, Real z, Real* gradient_x, Real* gradient_y,
                                             Real* gradient_z) {
  Real slope_x, slope_y, slope_z;
  Real open_x = axis_opening(p, kernel_shape, x, (Real)(p->size_x), shift, (Real)(1), &slope_x);
  Real open_y = axis_opening(p, kernel_shape, y, (Real)(p->size_y), shift, (Real)(p->lid), &slope_y);
  Real open_z = axis_opening(p, kernel_shape, z, (Real)(p->size_z), shift, (Real)(1), &slope_z);
  *gradient_x = slope_x * (open_y * open_z);
  *gradient_y = slope_y * (open_x * open_z);
  *gradient_z = slope_z * (open_x * open_y);
  return open_x * (open_y * open_z);
}

/* Integral of the kernel's marginal from minus infinity to `s` support radii. */
SQUALL_PARAMS_FORMULA Real marginal_integral(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape, Real s) {
  Real above = (Real)(1) - wall_share(p, kernel_shape, max0(s));
  return above + (wall_share(p, kernel_shape, max0(-s)) - (Real)(p->one_half));
}

/* Share of the support between two planes `low` and `high`, and its derivative along the axis. */
SQUALL_PARAMS_FORMULA Real slab_share(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape, Real coordinate,
                                      Real low, Real high, Real* slope) {
  Real inverse_support = (Real)(p->inverse_support);
  Real low_s = (low - coordinate) * inverse_support;
  Real high_s = (high - coordinate) * inverse_support;
  Real low_marginal = wall_marginal(p, kernel_shape, max0(low_s) + max0(-low_s));
  Real high_marginal = wall_marginal(p, kernel_shape, max0(high_s) + max0(-high_s));
  *slope = (low_marginal - high_marginal) * inverse_support;
  return marginal_integral(p, kernel_shape, high_s) - marginal_integral(p, kernel_shape, low_s);
}

/* Takes a solid box out of an open share and its gradient. */
SQUALL_PARAMS_FORMULA Real close_box(SQUALL_CONSTANT SQUALL_REF(Params) * p, int kernel_shape,
                                     SQUALL_CONSTANT Scalar* low, SQUALL_CONSTANT Scalar* high, Real x, Real y, Real z,
                                     Real open, Real* gradient_x, Real* gradient_y, Real* gradient_z) {
  Real slope_x, slope_y, slope_z;
  Real share_x = slab_share(p, kernel_shape, x, (Real)(low[0]), (Real)(high[0]), &slope_x);
  Real share_y = slab_share(p, kernel_shape, y, (Real)(low[1]), (Real)(high[1]), &slope_y);
  Real share_z = slab_share(p, kernel_shape, z, (Real)(low[2]), (Real)(high[2]), &slope_z);
  Real left = (Real)(1) - share_x * (share_y * share_z);
  *gradient_x = fma(*gradient_x, left, -(open * (slope_x * (share_y * share_z))));
  *gradient_y = fma(*gradient_y, left, -(open * (slope_y * (share_x * share_z))));
  *gradient_z = fma(*gradient_z, left, -(open * (slope_z * (share_x * share_y))));
  return open * left;
}

SQUALL_NAMESPACE_END

#endif
