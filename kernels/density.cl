/* Reads:  positions in sorted order, cell starts. Writes: density, isolation, and into the record's spare fields
   what neighbours need of its pressure and volume.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if !SQUALL_DFSPH && SQUALL_LANES == 1

#include "density_pass.h"

__kernel void density(__global const Scalar4* places, __global Scalar* records, __global Scalar* densities,
                      __global Scalar* isolations, __global const int* cell_start, __constant Params* p,
                      __constant Box* boxes, __global const Substep* substeps, int step) {
  int i = (int)get_global_id(0);
  if (i >= cell_start[p->cell_count]) return;
  density_pass(places, records, densities, isolations, cell_start, p, boxes, substeps[step].box_count, i);
}

#endif
