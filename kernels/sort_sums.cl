/* Reads:  values. Writes: the sum of every SQUALL_SORT_FAN of them: members of a tile from those of its bins, members
   of a group from those of its tiles.
   One work-item = one sum. */
#include "sort_bins.h"

#if SQUALL_LANES == 1

__kernel void sort_sums(__global const int4* values, __global int* sums, int count) {
  int i = (int)get_global_id(0);
  if (i >= count) return;
  __global const int4* own = values + (size_t)i * (SQUALL_SORT_FAN / 4);
  /* Four sums by name: a sum over a vector becomes shuffles that Oclgrind cannot follow. */
  int x = 0, y = 0, z = 0, w = 0;
  for (int k = 0; k < SQUALL_SORT_FAN / 4; ++k) {
    int4 four = own[k];
    x += four.x;
    y += four.y;
    z += four.z;
    w += four.w;
  }
  sums[i] = (x + y) + (z + w);
}

#endif
