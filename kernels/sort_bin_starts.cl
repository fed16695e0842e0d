/* Reads:  members of bins, tiles and groups. Writes: where each bin starts; zero into the bins' counts, for the next
   sort.
   One work-item = one tile of bins. */
#include "sort_bins.h"

#if SQUALL_LANES == 1

__kernel void sort_bin_starts(__global int4* counts, __global const int* tiles, __global const int* groups,
                              __global int4* starts, int tile_count) {
  int tile = (int)get_global_id(0);
  if (tile >= tile_count) return;
  int group = tile / SQUALL_SORT_FAN;
  int next = 0;
  for (int before = 0; before < group; ++before) next += groups[before];
  for (int before = group * SQUALL_SORT_FAN; before < tile; ++before) next += tiles[before];
  size_t first = (size_t)tile * (SQUALL_SORT_FAN / 4);
  for (size_t k = first; k < first + SQUALL_SORT_FAN / 4; ++k) {
    int4 members = counts[k];
    int4 start;
    start.x = next;
    start.y = start.x + members.x;
    start.z = start.y + members.y;
    start.w = start.z + members.z;
    next = start.w + members.w;
    vstore4(start, k, (__global int*)starts); /* stored as a vector it looks uninitialised to Oclgrind */
    counts[k] = (int4)(0);
  }
}

#endif
