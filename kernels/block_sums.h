/* OpenCL only, for CPU devices: acceleration of a block of particles by pressure, viscosity and walls, without gravity
   and drag. */
#ifndef SQUALL_BLOCK_SUMS_H
#define SQUALL_BLOCK_SUMS_H

#include "lists.h"
#include "search.h"

typedef struct {
  Real x, y, z;
} Vector;

typedef struct {
  Real x, y, z, pressure_term, vx, vy, vz, volume_term;
#if !SQUALL_WCSPH
  Real density, pressure;
#endif
} Lanes;

static inline void load_block(__global const float* records, const Places* places, const Block* block, Lanes* lanes) {
  lanes->x = load_own(places->x, block);
  lanes->y = load_own(places->y, block);
  lanes->z = load_own(places->z, block);
  lanes->pressure_term = gather(records, block, 3);
  lanes->vx = gather(records, block, 4);
  lanes->vy = gather(records, block, 5);
  lanes->vz = gather(records, block, 6);
  lanes->volume_term = gather(records, block, 7);
}

#if !SQUALL_WCSPH
static inline void load_pressure(__constant Params* p, __global const float* densities, const Block* block,
                                 Lanes* lanes) {
  lanes->density = gather_value(densities, block);
  lanes->pressure = mueller_pressure(lanes->density, (Real)(p->stiffness), (Real)(p->tension));
}
#endif

static inline void add_scaled(Vector* sum, Real s, Real x, Real y, Real z) {
  sum->x = fma(s, x, sum->x);
  sum->y = fma(s, y, sum->y);
  sum->z = fma(s, z, sum->z);
}

/* Gradient of the open share, 0 away from walls. */
static inline void opening_slope(__constant Params* p, __constant Box* boxes, int box_count, const Lanes* a,
                                 Vector* slope) {
  slope->x = slope->y = slope->z = (Real)(0);
#if SQUALL_BOXES
  if (box_count > 0 || near_container(p, a->x, a->y, a->z))
#else
  if (near_container(p, a->x, a->y, a->z))
#endif
    force_opening(p, boxes, box_count, a->x, a->y, a->z, &slope->x, &slope->y, &slope->z);
}

#if SQUALL_WCSPH

typedef struct {
  Vector push;
} PairSums;

static inline void add_pair(__constant Params* p, const Lanes* a, __global const float* b, PairSums* sums) {
  Real x = a->x - (Real)(b[0]), y = a->y - (Real)(b[1]), z = a->z - (Real)(b[2]);
  Real r2 = squared_length(x, y, z);
  Real r = sqrt(r2);
  Real slope = cubic_slope(remaining_support(r, (Real)(p->inverse_support)),
                           remaining_support(r, (Real)(p->inverse_half_support)));
  Real receding = dot_product(x, y, z, a->vx - (Real)(b[4]), a->vy - (Real)(b[5]), a->vz - (Real)(b[6]));
  Real shear = (Real)(p->artificial_scale) * max0(-receding);
#if SQUALL_VISCOSITY
  shear = nfma((Real)(p->viscosity_scale), receding, shear);
#endif
  Real s = wcsph_pair(r, r2, slope, a->pressure_term + (Real)(b[3]), a->volume_term + (Real)(b[7]), shear,
                      (Real)(p->softening), (Real)(p->tiny));
  add_scaled(&sums->push, s, x, y, z);
}

static inline Real total(__constant Params* p, const Lanes* a, Real push, Real slope) {
  return fma((Real)(p->force_scale), push, a->pressure_term * slope);
}
#define SQUALL_TOTAL(axis) total(p, a, sums.push.axis, slope.axis)

#else

typedef struct {
  Vector push, drag;
} PairSums;

static inline void add_pair(__constant Params* p, const Lanes* a, __global const float* b, PairSums* sums) {
  Real x = a->x - (Real)(b[0]), y = a->y - (Real)(b[1]), z = a->z - (Real)(b[2]);
  Real r = sqrt(squared_length(x, y, z));
  Real u = remaining_support(r, (Real)(p->inverse_support));
  add_scaled(&sums->push, mueller_pair(r, u, a->pressure, (Real)(b[7]), (Real)(b[3]), (Real)(p->tiny)), x, y, z);
#if SQUALL_VISCOSITY
  add_scaled(&sums->drag, viscosity_laplacian(u) * (Real)(b[7]), (Real)(b[4]) - a->vx, (Real)(b[5]) - a->vy,
             (Real)(b[6]) - a->vz);
#endif
}

static inline Real total(__constant Params* p, const Lanes* a, Real push, Real drag, Real slope) {
  Real force = fma((Real)(p->force_scale), push, a->pressure * slope);
#if SQUALL_VISCOSITY
  force = fma((Real)(p->viscosity_scale), drag, force);
#endif
  return force / a->density;
}
#define SQUALL_TOTAL(axis) total(p, a, sums.push.axis, sums.drag.axis, slope.axis)

#endif

static inline void sum_pairs(__constant Params* p, __global const float* records, const Places* places,
                             __global const int* cell_start, const Block* block, const Lanes* a,
                             __global const int* list, PairSums* sums) {
  int count = list[0];
  for (int k = 1; k <= count; ++k) add_pair(p, a, records + 8 * (size_t)list[k], sums);
  if (count != SQUALL_NO_LIST) return;
  Search search;
  begin_search(p, cell_start, block, a->x, a->y, a->z, &search);
  int found[SQUALL_BATCH + 1];
  while ((count = search_batch(p, places, &search, found)) > 0)
    for (int k = 0; k < count; ++k) add_pair(p, a, records + 8 * (size_t)found[k], sums);
}

static inline void fluid_acceleration(__constant Params* p, __constant Box* boxes, int box_count,
                                      __global const float* records, const Places* places,
                                      __global const int* cell_start, const Block* block, const Lanes* a,
                                      __global const int* list, Vector* result) {
  PairSums sums;
  sums.push.x = sums.push.y = sums.push.z = (Real)(0);
#if !SQUALL_WCSPH
  sums.drag = sums.push;
#endif
  sum_pairs(p, records, places, cell_start, block, a, list, &sums);
  Vector slope;
  opening_slope(p, boxes, box_count, a, &slope);
  result->x = SQUALL_TOTAL(x);
  result->y = SQUALL_TOTAL(y);
  result->z = SQUALL_TOTAL(z);
}

#endif
