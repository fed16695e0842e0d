/* dfsph, a light pass: reads and writes what push.cl does; reads also the lists of neighbours and their weights. One
   work-item = one share of the rows, in blocks of SQUALL_LANES particles. For CPU devices. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES > 1

#include "solve_blocks.h"

static inline void add_push(Vector* sum, const Lanes* a, __global const Scalar* b, Real weight) {
  add_scaled(sum, (Real)(b[3]) * weight, a->x - (Real)(b[0]), a->y - (Real)(b[1]), a->z - (Real)(b[2]));
}

static inline void pushed_sum(__constant Params* p, __global const Scalar* records, const Places* places,
                              __global const int* cell_start, const Block* block, const Lanes* a,
                              __global const int* list, __global const Real* weights, Vector* sum) {
  sum->x = sum->y = sum->z = (Real)(0);
  if (has_weights(list)) {
    for (int k = 0; k < list[0]; ++k) add_push(sum, a, records + 8 * (size_t)list[1 + k], weights[k]);
    return;
  }
  Neighbours neighbours;
  begin_neighbours(p, cell_start, block, a, list, &neighbours);
  int found[SQUALL_BATCH + 1], count;
  while ((count = next_neighbours(p, places, &neighbours, found)) > 0) {
    for (int k = 0; k < count; ++k) {
      __global const Scalar* b = records + 8 * (size_t)found[k];
      add_push(sum, a, b, weight_between(p, a, b));
    }
  }
}

/* Velocities of the block after every particle's change of impulse. */
static inline void push_block(__constant Params* p, __global Scalar* records, const Places* places,
                              __global const int* cell_start, __global Scalar* solve, int stride, const Block* block,
                              const Lanes* a, __global const int* list, __global const Real* weights) {
  Vector sum;
  pushed_sum(p, records, places, cell_start, block, a, list, weights, &sum);
  Real change = a->pressure_term;
  Real scale = (Real)(p->force_scale);
  Real hx = load_field(solve, SQUALL_DESCENT_X, stride, block), hy = load_field(solve, SQUALL_DESCENT_Y, stride, block),
       hz = load_field(solve, SQUALL_DESCENT_Z, stride, block);
  scatter(a->vx + fma(scale, sum.x, change * hx), block, 4, records);
  scatter(a->vy + fma(scale, sum.y, change * hy), block, 5, records);
  scatter(a->vz + fma(scale, sum.z, change * hz), block, 6, records);
  store_field(max0(load_field(solve, SQUALL_IMPULSE, stride, block) + change), SQUALL_IMPULSE, stride, block, solve);
}

__kernel void push_blocks(__global Scalar* records, __global const Scalar* x, __global const Scalar* y,
                          __global const Scalar* z, __global const int* cell_start, __global const int* lists,
                          __global const Real* weights, __global Scalar* solve, __global const SolveState* state,
                          __constant Params* p, int stride, int this_solve) {
  if (state->solve != this_solve) return;
  Places places = {x, y, z};
  Share share;
  take_share(p, cell_start, &share);
  __global const int* list = lists + SQUALL_LIST_ENTRIES * (size_t)share.begin;
  for (int row = share.row; row < share.end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      Lanes lanes;
      make_block(p, x, row, begin, row_end, &block);
      load_block(records, &places, &block, &lanes);
      push_block(p, records, &places, cell_start, solve, stride, &block, &lanes, list, weights + (list - lists));
      list += 1 + max(*list, 0);
    }
  }
}

#endif
