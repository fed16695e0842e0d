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

static inline void load_block(__global const Scalar* records, const Places* places, const Block* block, Lanes* lanes) {
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
static inline void load_pressure(__constant Params* p, __global const Scalar* densities, const Block* block,
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

/* What is under way for a stretch of a block's neighbours. Their contributions are made in three short loops instead of
   one long one: from a pair's load to its sum lies a chain of some 65 cycles, and a processor has registers for about
   three pairs in such a chain, but for many in each of its parts. */
#define SQUALL_STRETCH 32

typedef struct {
  Real x[SQUALL_STRETCH], y[SQUALL_STRETCH], z[SQUALL_STRETCH]; /* of the block's particles, from the neighbour */
  Real r[SQUALL_STRETCH];
#if SQUALL_WCSPH
  Real r2[SQUALL_STRETCH], receding[SQUALL_STRETCH];
#endif
  Real numerator[SQUALL_STRETCH], denominator[SQUALL_STRETCH]; /* of what x, y, z go into the sum with */
} Stretch;

#if SQUALL_WCSPH

typedef struct {
  Vector push;
} PairSums;

static inline void measure_pair(const Lanes* a, __global const Scalar* b, int k, Stretch* s) {
  s->x[k] = a->x - (Real)(b[0]);
  s->y[k] = a->y - (Real)(b[1]);
  s->z[k] = a->z - (Real)(b[2]);
  s->r2[k] = squared_length(s->x[k], s->y[k], s->z[k]);
  s->r[k] = sqrt(s->r2[k]);
  s->receding[k] =
      dot_product(s->x[k], s->y[k], s->z[k], a->vx - (Real)(b[4]), a->vy - (Real)(b[5]), a->vz - (Real)(b[6]));
}

static inline void weigh_pair(__constant Params* p, const Lanes* a, __global const Scalar* b, int k, Stretch* s,
                              PairSums* sums) {
  Real r = s->r[k], r2 = s->r2[k];
  Real slope = cubic_slope(remaining_support(r, (Real)(p->inverse_support)),
                           remaining_support(r, (Real)(p->inverse_half_support)));
  Real shear = (Real)(p->artificial_scale) * max0(-s->receding[k]);
#if SQUALL_VISCOSITY
  shear = nfma((Real)(p->viscosity_scale), s->receding[k], shear);
#endif
  s->numerator[k] = wcsph_numerator(r2, slope, a->pressure_term + (Real)(b[3]), a->volume_term + (Real)(b[7]), shear,
                                    (Real)(p->softening));
  s->denominator[k] = wcsph_denominator(r, r2, (Real)(p->softening), (Real)(p->tiny));
}

static inline Real total(__constant Params* p, const Lanes* a, Real push, Real slope) {
  return fma((Real)(p->force_scale), push, a->pressure_term * slope);
}
#define SQUALL_TOTAL(axis) total(p, a, sums.push.axis, slope.axis)

#else

typedef struct {
  Vector push, drag;
} PairSums;

static inline void measure_pair(const Lanes* a, __global const Scalar* b, int k, Stretch* s) {
  s->x[k] = a->x - (Real)(b[0]);
  s->y[k] = a->y - (Real)(b[1]);
  s->z[k] = a->z - (Real)(b[2]);
  s->r[k] = sqrt(squared_length(s->x[k], s->y[k], s->z[k]));
}

static inline void weigh_pair(__constant Params* p, const Lanes* a, __global const Scalar* b, int k, Stretch* s,
                              PairSums* sums) {
  Real u = remaining_support(s->r[k], (Real)(p->inverse_support));
  s->numerator[k] = mueller_numerator(u, a->pressure, (Real)(b[7]), (Real)(b[3]));
  s->denominator[k] = s->r[k] + (Real)(p->tiny);
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

/* Adds `count` neighbours, in the order of their list. */
static inline void sum_stretch(__constant Params* p, __global const Scalar* records, const Lanes* a, const int* list,
                               int count, PairSums* sums) {
  Stretch s;
  for (int k = 0; k < count; ++k) measure_pair(a, records + 8 * (size_t)list[k], k, &s);
  for (int k = 0; k < count; ++k) weigh_pair(p, a, records + 8 * (size_t)list[k], k, &s, sums);
  for (int k = 0; k < count; ++k) add_scaled(&sums->push, s.numerator[k] / s.denominator[k], s.x[k], s.y[k], s.z[k]);
}

static inline void sum_pairs(__constant Params* p, __global const Scalar* records, const Places* places,
                             __global const int* cell_start, const Block* block, const Lanes* a,
                             __global const int* list, PairSums* sums) {
  int found[SQUALL_BATCH + 1];
  if (list[0] != SQUALL_NO_LIST) {
    for (int first = 0; first < list[0]; first += SQUALL_STRETCH) {
      int count = min(list[0] - first, SQUALL_STRETCH);
      for (int k = 0; k < count; ++k) found[k] = list[1 + first + k];
      sum_stretch(p, records, a, found, count, sums);
    }
    return;
  }
  Search search;
  begin_search(p, cell_start, block, a->x, a->y, a->z, &search);
  int total_found;
  while ((total_found = search_batch(p, places, &search, found)) > 0)
    for (int first = 0; first < total_found; first += SQUALL_STRETCH)
      sum_stretch(p, records, a, found + first, min(total_found - first, SQUALL_STRETCH), sums);
}

static inline void fluid_acceleration(__constant Params* p, __constant Box* boxes, int box_count,
                                      __global const Scalar* records, const Places* places,
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
