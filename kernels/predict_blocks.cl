/* dfsph, between its solves: reads and writes what predict.cl does; reads also the lists of neighbours and their
   weights. One work-item = one share of the rows, in blocks of SQUALL_LANES particles; the last one also copies held
   and lost particles. For CPU devices. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES > 1

#include "integrate_block.h"
#include "solve_blocks.h"

typedef struct {
  Vector pushed, smoothed;
} Prediction;

static inline void predict_pair(__constant Params* p, Real viscous, const Lanes* a, __global const Scalar* b,
                                Real weight, Prediction* sums) {
  Real x = a->x - (Real)(b[0]), y = a->y - (Real)(b[1]), z = a->z - (Real)(b[2]);
  Real impulse = (Real)(b[7]);
#if SQUALL_VISCOSITY
  Real receding = dot_product(x, y, z, a->vx - (Real)(b[4]), a->vy - (Real)(b[5]), a->vz - (Real)(b[6]));
  impulse = viscous_pair_push(impulse, viscous, receding);
#endif
  add_scaled(&sums->pushed, impulse * weight, x, y, z);
#if SQUALL_SMOOTHING
  Real value = bell_value(bell_left(squared_length(x, y, z), (Real)(p->inverse_support_squared)));
  add_scaled(&sums->smoothed, value, (Real)(b[4]) - a->vx, (Real)(b[5]) - a->vy, (Real)(b[6]) - a->vz);
#endif
}

static inline void predict_from_neighbours(__constant Params* p, Scalar kick, __global const Scalar* sorted,
                                           const Places* places, __global const int* cell_start, const Block* block,
                                           const Lanes* a, __global const int* list, __global const Real* weights,
                                           Prediction* sums) {
  sums->pushed.x = sums->pushed.y = sums->pushed.z = (Real)(0);
  sums->smoothed = sums->pushed;
  Real viscous = (Real)(p->viscosity_scale * kick);
  if (has_weights(list)) {
    for (int k = 0; k < list[0]; ++k) predict_pair(p, viscous, a, sorted + 8 * (size_t)list[1 + k], weights[k], sums);
    return;
  }
  Neighbours neighbours;
  begin_neighbours(p, cell_start, block, a, list, &neighbours);
  int found[SQUALL_BATCH + 1], count;
  while ((count = next_neighbours(p, places, &neighbours, found)) > 0) {
    for (int k = 0; k < count; ++k) {
      __global const Scalar* b = sorted + 8 * (size_t)found[k];
      predict_pair(p, viscous, a, b, weight_between(p, a, b), sums);
    }
  }
}

/* One component of the velocity to start the density solve from. */
static inline Real predicted(__constant Params* p, __global const Substep* now, Real v, Real a, Real pushed,
                             Real from_own, Real smoothed) {
  Real next = fma((Real)(now->kick), a, v) + fma((Real)(p->force_scale), pushed, from_own);
#if SQUALL_SMOOTHING
  next = fma((Real)(p->smoothing_scale * now->dt), smoothed, next);
#endif
  return next;
}

static inline void predict_block(__constant Params* p, __global const Substep* now, const Block* block, const Lanes* at,
                                 const Prediction* sums, Scalar correction, __global const Scalar* densities,
                                 __global const Scalar* isolations, int stride, __global Scalar* solve,
                                 __global Scalar* records) {
  Vector a = {(Real)(0) + (Real)(now->acceleration_x), (Real)(0) + (Real)(now->acceleration_y),
              (Real)(0) + (Real)(now->acceleration_z)};
#if SQUALL_DRAG
  add_drag(p, now, block, at, isolations, &a);
#endif
  Real impulse = at->volume_term;
  Real hx = load_field(solve, SQUALL_DESCENT_X, stride, block), hy = load_field(solve, SQUALL_DESCENT_Y, stride, block),
       hz = load_field(solve, SQUALL_DESCENT_Z, stride, block);
  scatter(at->x, block, 0, records);
  scatter(at->y, block, 1, records);
  scatter(at->z, block, 2, records);
  scatter((Real)(0), block, 3, records);
  scatter(predicted(p, now, at->vx, a.x, sums->pushed.x, impulse * hx, sums->smoothed.x), block, 4, records);
  scatter(predicted(p, now, at->vy, a.y, sums->pushed.y, impulse * hy, sums->smoothed.y), block, 5, records);
  scatter(predicted(p, now, at->vz, a.z, sums->pushed.z, impulse * hz, sums->smoothed.z), block, 6, records);
  scatter((Real)(0), block, 7, records);
  store_field(impulse, SQUALL_IMPULSE, stride, block, solve);
  store_field(impulse, SQUALL_PROJECTED, stride, block, solve);
  store_field(density_room(gather_value(densities, block), (Real)(correction)), SQUALL_ROOM, stride, block, solve);
}

__kernel void predict_blocks(__global const Scalar* sorted, __global Scalar* records, __global const Scalar* densities,
                             __global const Scalar* isolations, __global const Scalar* x, __global const Scalar* y,
                             __global const Scalar* z, __global const int* cell_start, __global const int* lists,
                             __global const Real* weights, __global Scalar* solve, __global const SolveState* state,
                             __constant Params* p, __global const Substep* substeps, int stride, int step, int count) {
  if (state->solve != SQUALL_DENSITY_SOLVE) return;
  __global const Substep* now = substeps + step;
  Places places = {x, y, z};
  Share share;
  take_share(p, cell_start, &share);
  __global const int* list = lists + SQUALL_LIST_ENTRIES * (size_t)share.begin;
  for (int row = share.row; row < share.end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      Lanes lanes;
      Prediction sums;
      make_block(p, x, row, begin, row_end, &block);
      load_block(sorted, &places, &block, &lanes);
      predict_from_neighbours(p, now->kick, sorted, &places, cell_start, &block, &lanes, list, weights + (list - lists),
                              &sums);
      predict_block(p, now, &block, &lanes, &sums, state->correction, densities, isolations, stride, solve, records);
      list += 1 + max(*list, 0);
    }
  }
  if (get_global_id(0) != get_global_size(0) - 1) return;
  for (int i = cell_start[p->cell_count]; i < count; ++i) vstore8(vload8(i, sorted), i, records);
}

#endif
