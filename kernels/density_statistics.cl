/* Reads and writes what density.cl does, and writes the number of neighbours.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if !SQUALL_DFSPH && SQUALL_LANES == 1

#include "density_pass.h"

__kernel void density_statistics(__global const Scalar4* places, __global Scalar* records, __global Scalar* densities,
                                 __global Scalar* isolations, __global const int* cell_start, __constant Params* p,
                                 __constant Box* boxes, __global const Substep* substeps, int step,
                                 __global int* neighbours) {
  int i = (int)get_global_id(0);
  if (i >= cell_start[p->cell_count]) return;
  neighbours[i] =
      density_pass(places, records, densities, isolations, cell_start, p, boxes, substeps[step].box_count, i);
}

#endif
