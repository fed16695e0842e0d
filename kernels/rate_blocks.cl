/* dfsph, a light pass: reads and writes what rate.cl does, errors as this work-item's share of their sum; reads also
   the lists of neighbours and their weights. One work-item = one share of the rows, in blocks of SQUALL_LANES
   particles. For CPU devices. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES > 1

#include "solve_blocks.h"

static inline Real plus_approaching(Real sum, const Lanes* a, __global const Scalar* b, Real weight) {
  Real x = a->x - (Real)(b[0]), y = a->y - (Real)(b[1]), z = a->z - (Real)(b[2]);
  return fma(weight, dot_product(x, y, z, (Real)(b[4]), (Real)(b[5]), (Real)(b[6])), sum);
}

static inline Real approaching_sum(__constant Params* p, __global const Scalar* records, const Places* places,
                                   __global const int* cell_start, const Block* block, const Lanes* a,
                                   __global const int* list, __global const Real* weights) {
  Real sum = (Real)(0);
  if (has_weights(list)) {
    for (int k = 0; k < list[0]; ++k) sum = plus_approaching(sum, a, records + 8 * (size_t)list[1 + k], weights[k]);
    return sum;
  }
  Neighbours neighbours;
  begin_neighbours(p, cell_start, block, a, list, &neighbours);
  int found[SQUALL_BATCH + 1], count;
  while ((count = next_neighbours(p, places, &neighbours, found)) > 0) {
    for (int k = 0; k < count; ++k) {
      __global const Scalar* b = records + 8 * (size_t)found[k];
      sum = plus_approaching(sum, a, b, weight_between(p, a, b));
    }
  }
  return sum;
}

/* The block's part of an iteration, `sum` being its approaching_sum. Returns the sum of its errors. */
static inline long iterate_block(__constant Params* p, __global const Substep* now, const Block* block, const Lanes* a,
                                 Real sum, Scalar momentum, int stride, __global Scalar* records,
                                 __global Scalar* solve) {
  Real along = dot_product(a->vx, a->vy, a->vz, load_field(solve, SQUALL_DESCENT_X, stride, block),
                           load_field(solve, SQUALL_DESCENT_Y, stride, block),
                           load_field(solve, SQUALL_DESCENT_Z, stride, block));
  Real dt = (Real)(now->dt), impulse = load_field(solve, SQUALL_IMPULSE, stride, block);
  Real inverse = load_field(solve, SQUALL_INVERSE_RESPONSE, stride, block);
  Real before = load_field(solve, SQUALL_PROJECTED, stride, block);
  Real lack = lack_of_compression(load_field(solve, SQUALL_ROOM, stride, block), dt,
                                  compression_rate(sum, (Real)(p->force_scale), along));
  Real projected = projected_impulse(impulse, lack, (Real)(now->relaxation_rate), inverse);
  store_field(projected, SQUALL_PROJECTED, stride, block, solve);
  scatter(extrapolated_impulse(projected, before, (Real)(momentum)) - impulse, block, 3, records);
  Real response = load_field(solve, SQUALL_RESPONSE, stride, block);
  return sum_of_terms(solve_error(lack, impulse, dt, response, inverse), block);
}

__kernel void rate_blocks(__global Scalar* records, __global const Scalar* x, __global const Scalar* y,
                          __global const Scalar* z, __global const int* cell_start, __global const int* lists,
                          __global const Real* weights, __global Scalar* solve, __global long* shares,
                          __global const SolveState* state, __constant Params* p, __global const Substep* substeps,
                          int stride, int step, int this_solve) {
  if (state->solve != this_solve) return;
  Places places = {x, y, z};
  Share share;
  take_share(p, cell_start, &share);
  __global const int* list = lists + SQUALL_LIST_ENTRIES * (size_t)share.begin;
  long errors = 0;
  for (int row = share.row; row < share.end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      Lanes lanes;
      make_block(p, x, row, begin, row_end, &block);
      load_block(records, &places, &block, &lanes);
      Real sum = approaching_sum(p, records, &places, cell_start, &block, &lanes, list, weights + (list - lists));
      errors += iterate_block(p, substeps + step, &block, &lanes, sum, state->momentum, stride, records, solve);
      list += 1 + max(*list, 0);
    }
  }
  shares[get_global_id(0)] = errors;
}

#endif
