/* OpenCL only, for CPU devices: what dfsph's kernels for blocks of particles share. A record is {x, y, z, change of the
   impulse} {vx, vy, vz, impulse to start from}; each pass writes only fields that no other particle reads in it, and
   reads single fields of others for that reason. */
#ifndef SQUALL_SOLVE_BLOCKS_H
#define SQUALL_SOLVE_BLOCKS_H

#include "block_sums.h"
#include "dfsph_formulas.h"
#include "solve_state.h"

/* Where a block's neighbours come from, a batch after the other: from its list, or from a new search if it has none. */
typedef struct {
  __global const int* list;
  int next, length;
  Search search;
} Neighbours;

static inline void begin_neighbours(__constant Params* p, __global const int* cell_start, const Block* block,
                                    const Lanes* a, __global const int* list, Neighbours* neighbours) {
  neighbours->list = list + 1;
  neighbours->next = 0;
  neighbours->length = list[0];
  if (list[0] == SQUALL_NO_LIST) begin_search(p, cell_start, block, a->x, a->y, a->z, &neighbours->search);
}

/* The next neighbours, at most SQUALL_BATCH; 0 at the end. `found` has room for one more. */
static inline int next_neighbours(__constant Params* p, const Places* places, Neighbours* neighbours, int* found) {
  if (neighbours->length == SQUALL_NO_LIST) return search_batch(p, places, &neighbours->search, found);
  int count = min(neighbours->length - neighbours->next, SQUALL_BATCH);
  for (int k = 0; k < count; ++k) found[k] = neighbours->list[neighbours->next + k];
  neighbours->next += count;
  return count;
}

/* The block's values of a field of the solves. */
static inline Real load_field(__global const Scalar* solve, int field, int stride, const Block* block) {
  __global const Scalar* values = solve + (size_t)field * (size_t)stride;
  if (block->end - block->begin == SQUALL_LANES) return load_lanes(values + block->begin);
  return gather_value(values, block);
}

/* Writes the block's values and none behind them, which are another work-item's. */
static inline void store_values(Real value, const Block* block, __global Scalar* values) {
  if (block->end - block->begin == SQUALL_LANES) {
    store_lanes(value, values + block->begin);
    return;
  }
  Scalar lanes[SQUALL_LANES];
  store_lanes(value, lanes);
  for (int i = block->begin; i < block->end; ++i) values[i] = lanes[i - block->begin];
}

static inline void store_field(Real value, int field, int stride, const Block* block, __global Scalar* solve) {
  store_values(value, block, solve + (size_t)field * (size_t)stride);
}

/* Writes a field of the block's records. */
static inline void scatter(Real value, const Block* block, int field, __global Scalar* records) {
  Scalar lanes[SQUALL_LANES];
  store_lanes(value, lanes);
  for (int i = block->begin; i < block->end; ++i) records[8 * (size_t)i + field] = lanes[i - block->begin];
}

/* What the block adds to a sum that decides. */
static inline long sum_of_terms(Real errors, const Block* block) {
  Scalar lanes[SQUALL_LANES];
  store_lanes(errors, lanes);
  long sum = 0;
  for (int lane = 0; lane < block->end - block->begin; ++lane) sum += convergence_term(lanes[lane]);
  return sum;
}

/* Whether the weights of the list's pairs are kept. There is a vector of memory for each entry of the lists' memory,
   and the weights begin where the list does, at its length: the vector that is left over at the end takes what prepare
   writes beyond a list that is full. */
static inline int has_weights(__global const int* list) {
#if SQUALL_WEIGHTS
  return list[0] != SQUALL_NO_LIST;
#else
  return 0;
#endif
}

/* Computed again; the bits of one that was kept. Without the scale; 0 from H on. */
static inline Real weight_between(__constant Params* p, const Lanes* a, __global const Scalar* b) {
  Real r2 = squared_length(a->x - (Real)(b[0]), a->y - (Real)(b[1]), a->z - (Real)(b[2]));
  return bell_weight(bell_left(r2, (Real)(p->inverse_support_squared)));
}

#endif
