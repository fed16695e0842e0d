/* The cores of walls, for dfsph: a little more share of the support for particles that come within half a spacing of a
   face. The wall integral of walls.h is that of a smooth half space: it hardly rises over the last half spacing, so
   that a layer of particles which thins out keeps rest density right down to the face and comes to lie on it. With the
   core, such a layer is over-dense and its own pressure holds it off. A lattice, whose first layer is half a spacing
   away, feels nothing. Density and force take value and gradient of the same share, so the force stays the adjoint of
   the density (docs/dfsph.md). */
#ifndef SQUALL_WALL_CORES_H
#define SQUALL_WALL_CORES_H

#include "params.h"
#include "sph_formulas.h"

SQUALL_NAMESPACE_BEGIN

/* How far into a core a particle is, `distance` in front of the face: 1 at the face and behind it, 0 from the core's
   reach on. The share is this squared, times core_share. */
SQUALL_PARAMS_FORMULA Real core_depth(SQUALL_CONSTANT SQUALL_REF(Params) * p, Real distance) {
  return max0((Real)(1) - max0(distance * (Real)(p->inverse_core_reach)));
}

/* What the cores of two opposite faces leave open, and its derivative along the axis. */
SQUALL_PARAMS_FORMULA Real core_axis_opening(SQUALL_CONSTANT SQUALL_REF(Params) * p, Real coordinate, Real size,
                                             Real high_weight, Real* slope) {
  Real low_depth = core_depth(p, coordinate);
  Real high_depth = core_depth(p, size - coordinate);
  Real low_rise = (Real)(p->core_share) * low_depth;
  Real high_rise = (Real)(p->core_share) * high_weight * high_depth;
  Real low_open = nfma(low_rise, low_depth, (Real)(1));
  Real high_open = nfma(high_rise, high_depth, (Real)(1));
  *slope = (Real)(2) * (Real)(p->inverse_core_reach) * fma(low_rise, high_open, -(high_rise * low_open));
  return low_open * high_open;
}

/* Takes the container's cores out of an open share and its gradient (1/m). */
SQUALL_PARAMS_FORMULA Real close_container_cores(SQUALL_CONSTANT SQUALL_REF(Params) * p, Real x, Real y, Real z,
                                                 Real open, Real* gradient_x, Real* gradient_y, Real* gradient_z) {
  Real slope_x, slope_y, slope_z;
  Real open_x = core_axis_opening(p, x, (Real)(p->size_x), (Real)(1), &slope_x);
  Real open_y = core_axis_opening(p, y, (Real)(p->size_y), (Real)(p->lid), &slope_y);
  Real open_z = core_axis_opening(p, z, (Real)(p->size_z), (Real)(1), &slope_z);
  Real left = open_x * (open_y * open_z);
  *gradient_x = fma(*gradient_x, left, open * (slope_x * (open_y * open_z)));
  *gradient_y = fma(*gradient_y, left, open * (slope_y * (open_x * open_z)));
  *gradient_z = fma(*gradient_z, left, open * (slope_z * (open_x * open_y)));
  return open * left;
}

/* How far into the core around a slab [low, high], squared, and its derivative along the axis: 1 and 0 inside. */
SQUALL_PARAMS_FORMULA Real core_slab_share(SQUALL_CONSTANT SQUALL_REF(Params) * p, Real coordinate, Real low, Real high,
                                           Real* slope) {
  Real below = max0(low - coordinate);
  Real above = max0(coordinate - high);
  Real distance = below + above;
  Real depth = core_depth(p, distance);
  Real side = (below - above) / (distance + (Real)(p->tiny)); /* 1, 0 or -1 */
  *slope = (Real)(2) * (Real)(p->inverse_core_reach) * depth * side;
  return depth * depth;
}

/* Takes the core of a solid box out of an open share and its gradient. */
SQUALL_PARAMS_FORMULA Real close_box_core(SQUALL_CONSTANT SQUALL_REF(Params) * p, SQUALL_CONSTANT SQUALL_REF(Box) * box,
                                          Real x, Real y, Real z, Real open, Real* gradient_x, Real* gradient_y,
                                          Real* gradient_z) {
  Real slope_x, slope_y, slope_z;
  Real share_x = core_slab_share(p, x, (Real)(box->solid_min[0]), (Real)(box->solid_max[0]), &slope_x);
  Real share_y = core_slab_share(p, y, (Real)(box->solid_min[1]), (Real)(box->solid_max[1]), &slope_y);
  Real share_z = core_slab_share(p, z, (Real)(box->solid_min[2]), (Real)(box->solid_max[2]), &slope_z);
  Real core_share = (Real)(p->core_share);
  Real left = nfma(core_share * share_x, share_y * share_z, (Real)(1));
  Real scale = open * core_share;
  *gradient_x = fma(*gradient_x, left, -(scale * (slope_x * (share_y * share_z))));
  *gradient_y = fma(*gradient_y, left, -(scale * (slope_y * (share_x * share_z))));
  *gradient_z = fma(*gradient_z, left, -(scale * (slope_z * (share_x * share_y))));
  return open * left;
}

SQUALL_NAMESPACE_END

#endif
