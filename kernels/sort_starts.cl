/* Reads:  totals of the ranges. Writes: where each cell starts, and in place of each histogram entry where the chunk's
   particles of that cell go: cell by cell, within a cell chunk by chunk, which is what makes the sort stable.
   One work-item = one range of cells. */
#include "chunks.h"
#include "grid.h"

#if SQUALL_LANES > 1

__kernel void sort_starts(__global int* histograms, __global const int* totals, __global int* cell_start,
                          __constant Params* p, int chunks) {
  int range = (int)get_global_id(0);
  int ranges = (int)get_global_size(0);
  int key_count = p->cell_count + 2;
  int next = 0;
  for (int before = 0; before < range; ++before) next += totals[before];
  int end = chunk_begin(key_count, range + 1, ranges);
  for (int key = chunk_begin(key_count, range, ranges); key < end; ++key) {
    cell_start[key] = next;
    for (int chunk = 0; chunk < chunks; ++chunk) {
      size_t entry = (size_t)chunk * key_count + key;
      int members = histograms[entry];
      histograms[entry] = next;
      next += members;
    }
  }
  if (range == ranges - 1) cell_start[key_count] = next;
}

#endif
