/* dfsph, after its solves: reads and writes what drift.cl does. One work-item = one share of the rows, in blocks of
   SQUALL_LANES particles; the last one also takes held and lost particles. For CPU devices. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES > 1

#include "integrate_block.h"
#include "solve_blocks.h"

static inline void drift_block(__constant Params* p, __constant Box* boxes, __global const Substep* now,
                               const Block* block, const Lanes* at, __global const Scalar* solve, int stride,
                               __global Scalar* records, __global int* clamps) {
  Real inverse_kick = (Real)(now->inverse_kick);
  Vector v = {at->vx, at->vy, at->vz};
  Vector a = {(v.x - load_field(solve, SQUALL_START_VX, stride, block)) * inverse_kick,
              (v.y - load_field(solve, SQUALL_START_VY, stride, block)) * inverse_kick,
              (v.z - load_field(solve, SQUALL_START_VZ, stride, block)) * inverse_kick};
  Real pressure = load_field(solve, SQUALL_IMPULSE, stride, block) * inverse_kick;
  move_block(p, boxes, now, block, at, &a, &v, pressure, records, clamps);
}

__kernel void drift_blocks(__global Scalar* records, __global const Scalar* x, __global const Scalar* y,
                           __global const Scalar* z, __global const int* cell_start, __global const Scalar* solve,
                           __global int* clamps, __global const SolveState* state, __constant Params* p,
                           __constant Box* boxes, __global const Substep* substeps, int stride, int step, int count) {
  if (state->solve != SQUALL_SOLVED) return;
  Places places = {x, y, z};
  Share share;
  take_share(p, cell_start, &share);
  for (int row = share.row; row < share.end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      Lanes lanes;
      make_block(p, x, row, begin, row_end, &block);
      load_block(records, &places, &block, &lanes);
      drift_block(p, boxes, substeps + step, &block, &lanes, solve, stride, records, clamps);
    }
  }
  if (get_global_id(0) != get_global_size(0) - 1) return;
  for (int i = cell_start[p->cell_count]; i < count; ++i) records[8 * (size_t)i + 7] = -1.0f;
}

#endif
