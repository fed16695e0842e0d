/* OpenCL only, for CPU devices: blocks of up to SQUALL_LANES consecutive particles of one row of cells, one per lane of
   a vector; a work-item takes a contiguous share of the rows. Structures go through pointers: returned by value they
   leave marks in the intermediate code that Oclgrind cannot read. */
#ifndef SQUALL_BLOCKS_H
#define SQUALL_BLOCKS_H

#include "grid.h"
#include "openings.h"

/* A mask has -1 or 0 per lane, in integers as wide as the lanes. */
#if SQUALL_DOUBLE
typedef long MaskLane;
typedef long2 Mask2;
typedef long4 Mask4;
#if SQUALL_LANES == 8
typedef long8 Mask;
#define as_mask as_long8
#define as_real as_double8
#else
typedef Mask4 Mask;
#define as_mask as_long4
#define as_real as_double4
#endif
#else
typedef int MaskLane;
typedef int2 Mask2;
typedef int4 Mask4;
#if SQUALL_LANES == 16
typedef int16 Mask;
#define as_mask as_int16
#define as_real as_float16
#else
typedef int8 Mask;
#define as_mask as_int8
#define as_real as_float8
#endif
#endif

#if SQUALL_LANES == 16
#define load_lanes(from) vload16(0, from)
#define store_lanes(value, to) vstore16(value, 0, to)
#define k_lane_numbers ((Mask)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define any_of_four(m) (((m).lo | (m).hi).lo | ((m).lo | (m).hi).hi)
#elif SQUALL_LANES == 8
#define load_lanes(from) vload8(0, from)
#define store_lanes(value, to) vstore8(value, 0, to)
#define k_lane_numbers ((Mask)(0, 1, 2, 3, 4, 5, 6, 7))
#define any_of_four(m) ((m).lo | (m).hi)
#else
#define load_lanes(from) vload4(0, from)
#define store_lanes(value, to) vstore4(value, 0, to)
#define k_lane_numbers ((Mask)(0, 1, 2, 3))
#define any_of_four(m) (m)
#endif

static inline int any_lane(Mask m) { /* any() costs four times as much on a CPU */
  Mask4 four = any_of_four(m);
  Mask2 two = four.lo | four.hi;
  return (two.x | two.y) != 0;
}

typedef struct {
  int begin, end; /* sorted indices */
  int cell_y, cell_z, first_x, last_x;
} Block;

/* Row at which part `part` of `parts` begins: rows are shared out by particle count. */
static inline int row_split(__constant Params* p, __global const int* cell_start, int part, int parts) {
  int rows = p->cells_y * p->cells_z;
  if (part == 0) return 0;
  if (part == parts) return rows;
  int target = (int)((long)cell_start[p->cell_count] * part / parts);
  int low = 0, high = rows;
  while (low < high) {
    int middle = (low + high) / 2;
    if (cell_start[middle * p->cells_x] < target)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* A work-item's rows, and the sorted particles in them. */
typedef struct {
  int row, end_row;
  int begin, end;
} Share;

static inline void take_share(__constant Params* p, __global const int* cell_start, Share* share) {
  int part = (int)get_global_id(0), parts = (int)get_global_size(0);
  share->row = row_split(p, cell_start, part, parts);
  share->end_row = row_split(p, cell_start, part + 1, parts);
  share->begin = cell_start[share->row * p->cells_x];
  share->end = cell_start[share->end_row * p->cells_x];
}

/* A field of the block's records; lanes past the end repeat the last particle. */
static inline Real gather(__global const Scalar* records, const Block* block, int field) {
  Scalar lanes[SQUALL_LANES];
  for (int lane = 0; lane < SQUALL_LANES; ++lane)
    lanes[lane] = records[8 * (size_t)min(block->begin + lane, block->end - 1) + field];
  return load_lanes(lanes);
}

/* The block's part of an array with a value per sorted particle, likewise. */
static inline Real gather_value(__global const Scalar* values, const Block* block) {
  Scalar lanes[SQUALL_LANES];
  for (int lane = 0; lane < SQUALL_LANES; ++lane) lanes[lane] = values[min(block->begin + lane, block->end - 1)];
  return load_lanes(lanes);
}

/* Likewise, where the array can be read SQUALL_LANES - 1 values further than its last particle. */
static inline Real load_own(__global const Scalar* values, const Block* block) {
  int last = block->end - 1 - block->begin;
  return select(load_lanes(values + block->begin), (Real)(values[block->end - 1]), k_lane_numbers > (Mask)(last));
}

/* The block that starts at `begin` in a row that ends at `row_end`; `x` of all sorted particles. */
static inline void make_block(__constant Params* p, __global const Scalar* x, int row, int begin, int row_end,
                              Block* block) {
  block->begin = begin;
  block->end = min(begin + SQUALL_LANES, row_end);
  block->cell_y = row % p->cells_y;
  block->cell_z = row / p->cells_y;
  int low = cell_coordinate(x[begin], p->inverse_edge_x, p->cells_x);
  int high = cell_coordinate(x[block->end - 1], p->inverse_edge_x, p->cells_x);
  block->first_x = max(low - SQUALL_X_FINENESS, 0);
  block->last_x = min(high + SQUALL_X_FINENESS, p->cells_x - 1);
}

__constant Mask k_only_even[2] = {(Mask)(-1), (Mask)(0)};

/* Adds the value, to which sorted particle j amounts, to the sum of its parity, and exactly zero to the other. */
static inline void add_by_parity(Real value, int j, Real* even, Real* odd) {
  *even += as_real(as_mask(value) & k_only_even[j & 1]);
  *odd += as_real(as_mask(value) & k_only_even[1 - (j & 1)]);
}

/* Whether any lane is near a wall of the container. */
static inline int near_container(__constant Params* p, Real x, Real y, Real z) {
  Real reach = (Real)(p->support_radius);
  Mask outside = (x < reach) | (x > (Real)(p->size_x) - reach) | (y < reach) | (y > (Real)(p->size_y) - reach) |
                 (z < reach) | (z > (Real)(p->size_z) - reach);
  return any_lane(outside);
}

#endif
