/* OpenCL only, for CPU devices: the candidates of a block that lie within reach of the smallest box around its
   particles, in canonical order: a superset of everybody's neighbours, and what is further away adds exactly zero.
   Candidates are tested SQUALL_LANES at a time, a candidate per lane. The rounded distance to the box is never longer
   than the rounded distance to a particle in it, because both are the same monotonic operations. */
#ifndef SQUALL_SEARCH_H
#define SQUALL_SEARCH_H

#include "blocks.h"

/* So many candidates are collected before something is done about them: a few times what a block at rest has. */
#define SQUALL_BATCH 384

/* Sorted positions, an array per axis. */
typedef struct {
  __global const Scalar *x, *y, *z;
} Places;

typedef struct {
  Scalar low_x, low_y, low_z, high_x, high_y, high_z;
} Bounds;

/* The block's candidates: up to nine ranges of sorted indices, in ascending order, and where the search stands. */
typedef struct {
  Bounds bounds;
  int begins[10], ends[10]; /* one more than there are rows: the search looks there when it is done */
  int count;                /* of ranges; none is empty */
  int range, next;          /* the range and the candidate that come next */
} Search;

static inline Scalar smallest_lane(Real v) {
#if SQUALL_LANES == 16
  Scalar8 eight = min(v.lo, v.hi);
  Scalar4 four = min(eight.lo, eight.hi);
#elif SQUALL_LANES == 8
  Scalar4 four = min(v.lo, v.hi);
#else
  Scalar4 four = v;
#endif
  Scalar2 two = min(four.lo, four.hi);
  return min(two.x, two.y);
}

static inline void set_bounds(Real x, Real y, Real z, Bounds* bounds) {
  bounds->low_x = smallest_lane(x);
  bounds->low_y = smallest_lane(y);
  bounds->low_z = smallest_lane(z);
  bounds->high_x = -smallest_lane(-x);
  bounds->high_y = -smallest_lane(-y);
  bounds->high_z = -smallest_lane(-z);
}

static inline void begin_search(__constant Params* p, __global const int* cell_start, const Block* block, Real x,
                                Real y, Real z, Search* search) {
  set_bounds(x, y, z, &search->bounds);
  int count = 0;
  int last_y = min(block->cell_y + 1, p->cells_y - 1), last_z = min(block->cell_z + 1, p->cells_z - 1);
  for (int cell_z = max(block->cell_z - 1, 0); cell_z <= last_z; ++cell_z) {
    for (int cell_y = max(block->cell_y - 1, 0); cell_y <= last_y; ++cell_y) {
      __global const int* row = cell_start + (size_t)((cell_z * p->cells_y + cell_y) * p->cells_x);
      int begin = row[block->first_x], end = row[block->last_x + 1];
      search->begins[count] = begin;
      search->ends[count] = end;
      count += begin < end;
    }
  }
  search->begins[count] = search->ends[count] = 0;
  search->count = count;
  search->range = 0;
  search->next = search->begins[0];
}

/* How far outside [low, high]. */
static inline Real outside(Real low, Real high, Real x) { return max(max(low - x, x - high), (Real)(0)); }

/* -1 for each of the SQUALL_LANES candidates from j on that is within reach of the box. */
static inline Mask near_bounds(__constant Params* p, const Places* places, const Bounds* bounds, int j) {
  Real x = outside((Real)(bounds->low_x), (Real)(bounds->high_x), load_lanes(places->x + j));
  Real y = outside((Real)(bounds->low_y), (Real)(bounds->high_y), load_lanes(places->y + j));
  Real z = outside((Real)(bounds->low_z), (Real)(bounds->high_z), load_lanes(places->z + j));
  return squared_length(x, y, z) < (Real)(p->list_squared);
}

static inline int search_ended(const Search* search) { return search->range == search->count; }

/* Collects the next candidates, at most SQUALL_BATCH, and writes over one entry of `found` behind them, also if there
   are none: what the last batch left there is gone. Without a branch but the loop's own: how long the ranges are, no
   processor can guess. */
static inline int search_batch(__constant Params* p, const Places* places, Search* search, int* found) {
  uint count = 0; /* unsigned: an index without a sign to extend */
  int range = search->range, j = search->next;
  while (range < search->count && count <= SQUALL_BATCH - SQUALL_LANES) {
    int end = search->ends[range];
    Mask hit = near_bounds(p, places, &search->bounds, j) & (k_lane_numbers < (Mask)(end - j));
    MaskLane hits[SQUALL_LANES];
    store_lanes(hit, hits);
#pragma unroll
    for (int lane = 0; lane < SQUALL_LANES; ++lane) {
      found[count] = j + lane;
      count -= (uint)hits[lane];
    }
    j += SQUALL_LANES;
    int leaves = j >= end;
    range += leaves;
    j = leaves ? search->begins[range] : j;
  }
  search->range = range;
  search->next = j;
  return (int)count;
}

#endif
