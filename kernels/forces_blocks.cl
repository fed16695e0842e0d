/* Reads and writes what forces.cl does.
   One work-item = one share of the rows, in blocks of SQUALL_LANES particles; the last one also copies held and lost
   particles. For CPU devices. */
#include "shared.h"

#if SQUALL_LANES > 1

#include "block_sums.h"
#include "integrate_block.h"

__kernel void forces_blocks(__global const float* sorted, __global float* records, __global const float* densities,
                            __global const float* isolations, __global const int* cell_start, __global int* clamps,
                            __constant Params* p, __constant Box* boxes, __global const Substep* substeps, int step,
                            int count) {
  __global const Substep* now = substeps + step;
  int part = (int)get_global_id(0), parts = (int)get_global_size(0);
  int end_row = row_split(p, cell_start, part + 1, parts);
  for (int row = row_split(p, cell_start, part, parts); row < end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      Lanes lanes;
      Vector a;
      make_block(p, sorted, row, begin, row_end, &block);
      load_block(sorted, &block, &lanes);
#if !SQUALL_WCSPH
      load_pressure(p, densities, &block, &lanes);
#endif
      fluid_acceleration(p, boxes, now->box_count, sorted, cell_start, &block, &lanes, &a);
      integrate_block(p, boxes, now, &block, &lanes, &a, isolations, records, clamps);
    }
  }
  if (part != parts - 1) return;
  for (int i = cell_start[p->cell_count]; i < count; ++i) {
    float8 record = vload8(i, sorted);
    record.s3 = 0.0f;
    record.s7 = 0.0f;
    vstore8(record, i, records);
  }
}

#endif
