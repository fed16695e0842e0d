/* Reads and writes what forces.cl does; reads also the lists of neighbours.
   One work-item = one share of the rows, in blocks of SQUALL_LANES particles; the last one also copies held and lost
   particles. For CPU devices. */
#include "shared.h"
#include "switches.h"

#if !SQUALL_DFSPH && SQUALL_LANES > 1

#include "block_sums.h"
#include "integrate_block.h"

__kernel void forces_blocks(__global const Scalar* sorted, __global Scalar* records, __global const Scalar* densities,
                            __global const Scalar* isolations, __global const Scalar* x, __global const Scalar* y,
                            __global const Scalar* z, __global const int* cell_start, __global const int* lists,
                            __global int* clamps, __constant Params* p, __constant Box* boxes,
                            __global const Substep* substeps, int step, int count) {
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
      Vector a;
      make_block(p, x, row, begin, row_end, &block);
      load_block(sorted, &places, &block, &lanes);
#if !SQUALL_WCSPH
      load_pressure(p, densities, &block, &lanes);
#endif
      fluid_acceleration(p, boxes, now->box_count, sorted, &places, cell_start, &block, &lanes, list, &a);
      integrate_block(p, boxes, now, &block, &lanes, &a, isolations, records, clamps);
      list += 1 + max(*list, 0);
    }
  }
  if (get_global_id(0) != get_global_size(0) - 1) return;
  for (int i = cell_start[p->cell_count]; i < count; ++i) {
    Scalar8 record = vload8(i, sorted);
    record.s3 = 0.0f;
    record.s7 = 0.0f;
    vstore8(record, i, records);
  }
}

#endif
