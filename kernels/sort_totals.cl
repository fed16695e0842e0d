/* Reads:  the chunks' histograms. Writes: how many particles the range of cells holds.
   One work-item = one range of cells. */
#include "chunks.h"
#include "grid.h"

#if SQUALL_LANES > 1

__kernel void sort_totals(__global const int* histograms, __global int* totals, __constant Params* p, int chunks) {
  int range = (int)get_global_id(0);
  int ranges = (int)get_global_size(0);
  int key_count = p->cell_count + 2;
  int end = chunk_begin(key_count, range + 1, ranges);
  int total = 0;
  for (int chunk = 0; chunk < chunks; ++chunk) {
    __global const int* histogram = histograms + (size_t)chunk * key_count;
    for (int key = chunk_begin(key_count, range, ranges); key < end; ++key) total += histogram[key];
  }
  totals[range] = total;
}

#endif
