/* OpenCL only, for CPU devices: blocks of up to SQUALL_LANES consecutive particles of one row of cells, one per lane of
   a vector; a work-item takes a contiguous share of the rows. Candidates are tested a batch at a time, and those within
   reach of any lane visited: what is further away adds exactly zero. Structures go through pointers: returned by value
   they leave marks in the intermediate code that Oclgrind cannot read. */
#ifndef SQUALL_BLOCKS_H
#define SQUALL_BLOCKS_H

#include "grid.h"
#include "openings.h"

#define SQUALL_BATCH 64

#if SQUALL_LANES == 16
typedef int16 Mask;
#define load_lanes(from) vload16(0, from)
#define store_lanes(value, to) vstore16(value, 0, to)
static inline int any_lane(Mask m) {
  int8 half_lanes = m.lo | m.hi; /* any() costs four times as much on a CPU */
  int4 quarter = half_lanes.lo | half_lanes.hi;
  int2 eighth = quarter.lo | quarter.hi;
  return (eighth.x | eighth.y) != 0;
}
#else
typedef int8 Mask;
#define load_lanes(from) vload8(0, from)
#define store_lanes(value, to) vstore8(value, 0, to)
static inline int any_lane(Mask m) {
  int4 quarter = m.lo | m.hi;
  int2 eighth = quarter.lo | quarter.hi;
  return (eighth.x | eighth.y) != 0;
}
#endif

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

/* A field of the block's records; lanes past the end repeat the last particle. */
static inline Real gather(__global const float* records, const Block* block, int field) {
  float lanes[SQUALL_LANES];
  for (int lane = 0; lane < SQUALL_LANES; ++lane)
    lanes[lane] = records[8 * (size_t)min(block->begin + lane, block->end - 1) + field];
  return load_lanes(lanes);
}

/* The block's part of an array with a value per sorted particle, likewise. */
static inline Real gather_value(__global const float* values, const Block* block) {
  float lanes[SQUALL_LANES];
  for (int lane = 0; lane < SQUALL_LANES; ++lane) lanes[lane] = values[min(block->begin + lane, block->end - 1)];
  return load_lanes(lanes);
}

/* The block that starts at `begin` in a row that ends at `row_end`. */
static inline void make_block(__constant Params* p, __global const float* records, int row, int begin, int row_end,
                              Block* block) {
  block->begin = begin;
  block->end = min(begin + SQUALL_LANES, row_end);
  block->cell_y = row % p->cells_y;
  block->cell_z = row / p->cells_y;
  int low = cell_coordinate(records[8 * (size_t)begin], p->inverse_edge_x, p->cells_x);
  int high = cell_coordinate(records[8 * (size_t)(block->end - 1)], p->inverse_edge_x, p->cells_x);
  block->first_x = max(low - SQUALL_X_FINENESS, 0);
  block->last_x = min(high + SQUALL_X_FINENESS, p->cells_x - 1);
}

/* The candidates of a block, batch by batch, in canonical order. */
typedef struct {
  int y, z;      /* the row of cells that comes next */
  int next, end; /* what is left of the current one */
} Walk;

static inline void begin_walk(const Block* block, Walk* walk) {
  walk->y = block->cell_y - 1;
  walk->z = block->cell_z - 1;
  walk->next = walk->end = 0;
}

/* Moves to the next row that has candidates left; 0 when there is none. */
static inline int has_candidates(__constant Params* p, __global const int* cell_start, const Block* block, Walk* walk) {
  while (walk->next >= walk->end) {
    if (walk->z > block->cell_z + 1) return 0;
    if (walk->y >= 0 && walk->y < p->cells_y && walk->z >= 0 && walk->z < p->cells_z) {
      int first_cell = (walk->z * p->cells_y + walk->y) * p->cells_x;
      walk->next = cell_start[first_cell + block->first_x];
      walk->end = cell_start[first_cell + block->last_x + 1];
    }
    if (++walk->y > block->cell_y + 1) {
      walk->y = block->cell_y - 1;
      ++walk->z;
    }
  }
  return 1;
}

static inline int in_reach(__constant Params* p, __global const float* records, int j, Real x, Real y, Real z) {
  __global const float* at = records + 8 * (size_t)j;
  return any_lane(squared_length(x - (Real)(at[0]), y - (Real)(at[1]), z - (Real)(at[2])) < (Real)(p->list_squared));
}

/* Whether any lane is near a wall of the container. */
static inline int near_container(__constant Params* p, Real x, Real y, Real z) {
  Real reach = (Real)(p->support_radius);
  Mask outside = (x < reach) | (x > (Real)(p->size_x) - reach) | (y < reach) | (y > (Real)(p->size_y) - reach) |
                 (z < reach) | (z > (Real)(p->size_z) - reach);
  return any_lane(outside);
}

#endif
