/* OpenCL only: acceleration of one particle by pressure, viscosity and walls, without gravity and drag. A record is
   {x, y, z, pressure term} {vx, vy, vz, volume term}; sums run over candidates in ascending sorted index. */
#ifndef SQUALL_PAIR_SUMS_H
#define SQUALL_PAIR_SUMS_H

#include "neighbour_rows.h"
#include "openings.h"

typedef struct {
  float4 place, motion; /* a record */
  float density, pressure;
} Body;

typedef struct {
  float4 push, drag;
} PairSum;

#if SQUALL_WCSPH

static inline void add_pair(__constant Params* p, const Body* a, float4 place, float4 motion, PairSum* sum) {
  float4 way = a->place - place; /* w means nothing, here and in the sums */
  float r2 = squared_length(way.x, way.y, way.z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  float r = sqrt(r2);
  float slope = cubic_slope(remaining_support(r, p->inverse_support), remaining_support(r, p->inverse_half_support));
  float4 speed = a->motion - motion;
  float receding = dot_product(way.x, way.y, way.z, speed.x, speed.y, speed.z);
  float shear = p->artificial_scale * max0(-receding);
#if SQUALL_VISCOSITY
  shear = fma(-p->viscosity_scale, receding, shear);
#endif
  float s = wcsph_pair(r, r2, slope, a->place.w + place.w, a->motion.w + motion.w, shear, p->softening, p->tiny);
  sum->push = fma((float4)(s), way, sum->push);
}

static inline float4 acceleration_of(__constant Params* p, const Body* a, const PairSum* sum, float4 opening_slope) {
  return fma((float4)(p->force_scale), sum->push, a->place.w * opening_slope);
}

#else

static inline void add_pair(__constant Params* p, const Body* a, float4 place, float4 motion, PairSum* sum) {
  float4 way = a->place - place; /* w means nothing, here and in the sums */
  float r2 = squared_length(way.x, way.y, way.z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  float r = sqrt(r2);
  float u = remaining_support(r, p->inverse_support);
  float s = mueller_pair(r, u, a->pressure, motion.w, place.w, p->tiny);
  sum->push = fma((float4)(s), way, sum->push);
#if SQUALL_VISCOSITY
  sum->drag = fma((float4)(viscosity_laplacian(u) * motion.w), motion - a->motion, sum->drag);
#endif
}

static inline float4 acceleration_of(__constant Params* p, const Body* a, const PairSum* sum, float4 opening_slope) {
  float4 force = fma((float4)(p->force_scale), sum->push, a->pressure * opening_slope);
#if SQUALL_VISCOSITY
  force = fma((float4)(p->viscosity_scale), sum->drag, force);
#endif
  return force / a->density;
}

#endif

static inline float4 fluid_acceleration(__global const float4* records, __global const int* cell_start,
                                        __constant Params* p, __constant Box* boxes, int box_count, float4 place,
                                        float4 motion, float density) {
  Body a = {place, motion, density, mueller_pressure(density, p->stiffness, p->tension)};
  PairSum sum = {(float4)(0.0f), (float4)(0.0f)};
  Neighbourhood cells = neighbourhood(p, place.x, place.y, place.z);
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) add_pair(p, &a, records[2 * (size_t)j], records[2 * (size_t)j + 1], &sum);
    }
  }
  float slope_x, slope_y, slope_z;
  force_opening(p, boxes, box_count, place.x, place.y, place.z, &slope_x, &slope_y, &slope_z);
  return acceleration_of(p, &a, &sum, (float4)(slope_x, slope_y, slope_z, 0.0f));
}

#endif
