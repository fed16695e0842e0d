/* OpenCL only: acceleration of one particle by pressure, viscosity and walls, without gravity and drag. A record is
   {x, y, z, pressure term} {vx, vy, vz, volume term}; sums run over candidates in ascending sorted index. */
#ifndef SQUALL_PAIR_SUMS_H
#define SQUALL_PAIR_SUMS_H

#include "neighbour_rows.h"
#include "openings.h"

typedef struct {
  Scalar4 place, motion; /* a record */
  Scalar density, pressure;
} Body;

typedef struct {
  Scalar4 push, drag;
} PairSum;

#if SQUALL_WCSPH

static inline void add_pair(__constant Params* p, const Body* a, Scalar4 place, Scalar4 motion, PairSum* sum) {
  Scalar4 way = a->place - place; /* w means nothing, here and in the sums */
  Scalar r2 = squared_length(way.x, way.y, way.z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  Scalar r = sqrt(r2);
  Scalar slope = cubic_slope(remaining_support(r, p->inverse_support), remaining_support(r, p->inverse_half_support));
  Scalar4 speed = a->motion - motion;
  Scalar receding = dot_product(way.x, way.y, way.z, speed.x, speed.y, speed.z);
  Scalar shear = p->artificial_scale * max0(-receding);
#if SQUALL_VISCOSITY
  shear = fma(-p->viscosity_scale, receding, shear);
#endif
  Scalar s = wcsph_pair(r, r2, slope, a->place.w + place.w, a->motion.w + motion.w, shear, p->softening, p->tiny);
  sum->push = fma((Scalar4)(s), way, sum->push);
}

static inline Scalar4 acceleration_of(__constant Params* p, const Body* a, const PairSum* sum, Scalar4 opening_slope) {
  return fma((Scalar4)(p->force_scale), sum->push, a->place.w * opening_slope);
}

#else

static inline void add_pair(__constant Params* p, const Body* a, Scalar4 place, Scalar4 motion, PairSum* sum) {
  Scalar4 way = a->place - place; /* w means nothing, here and in the sums */
  Scalar r2 = squared_length(way.x, way.y, way.z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  Scalar r = sqrt(r2);
  Scalar u = remaining_support(r, p->inverse_support);
  Scalar s = mueller_pair(r, u, a->pressure, motion.w, place.w, p->tiny);
  sum->push = fma((Scalar4)(s), way, sum->push);
#if SQUALL_VISCOSITY
  sum->drag = fma((Scalar4)(viscosity_laplacian(u) * motion.w), motion - a->motion, sum->drag);
#endif
}

static inline Scalar4 acceleration_of(__constant Params* p, const Body* a, const PairSum* sum, Scalar4 opening_slope) {
  Scalar4 force = fma((Scalar4)(p->force_scale), sum->push, a->pressure * opening_slope);
#if SQUALL_VISCOSITY
  force = fma((Scalar4)(p->viscosity_scale), sum->drag, force);
#endif
  return force / a->density;
}

#endif

static inline Scalar4 fluid_acceleration(__global const Scalar4* records, __global const int* cell_start,
                                         __constant Params* p, __constant Box* boxes, int box_count, Scalar4 place,
                                         Scalar4 motion, Scalar density) {
  Body a = {place, motion, density, mueller_pressure(density, p->stiffness, p->tension)};
  PairSum sum = {(Scalar4)(0.0f), (Scalar4)(0.0f)};
  Neighbourhood cells = neighbourhood(p, place.x, place.y, place.z);
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) add_pair(p, &a, records[2 * (size_t)j], records[2 * (size_t)j + 1], &sum);
    }
  }
  Scalar slope_x, slope_y, slope_z;
  force_opening(p, boxes, box_count, place.x, place.y, place.z, &slope_x, &slope_y, &slope_z);
  return acceleration_of(p, &a, &sum, (Scalar4)(slope_x, slope_y, slope_z, 0.0f));
}

#endif
