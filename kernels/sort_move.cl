/* Reads:  records and ids in their old order, bins and their members. Writes: records and ids in canonical order, and
   the positions once more for density.cl, which needs nothing else of its neighbours.
   A particle of a cell with m particles reads m indices here; density.cl reads as many positions and does more with
   each, so crowds cost this kernel a fraction of what they cost there.
   One work-item = one particle. */
#include "sort_bins.h"

#if SQUALL_LANES == 1

__kernel void sort_move(__global const Scalar4* records, __global const uint* ids, __global const int* bins,
                        __global const int* members, __global const int* starts, __global Scalar4* sorted,
                        __global uint* sorted_ids, __global Scalar4* places, int count) {
  int i = (int)get_global_id(0);
  if (i >= count) return;
  int begin = starts[bins[i]], end = starts[bins[i] + 1];
  int smaller = 0;
  for (int m = begin; m < end; ++m) smaller += members[m] < i;
  size_t to = (size_t)(begin + smaller);
  Scalar4 position = records[2 * (size_t)i];
  sorted[2 * to] = position;
  sorted[2 * to + 1] = records[2 * (size_t)i + 1];
  sorted_ids[to] = ids[i];
  places[to] = position;
}

#endif
