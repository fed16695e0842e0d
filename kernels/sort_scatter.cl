/* Reads:  records and ids in their old order, each chunk's places. Writes: records and ids in canonical order, and the
   positions once more, an array per axis.
   One work-item = one chunk of particles. */
#include "chunks.h"
#include "grid.h"

#if SQUALL_LANES > 1

__kernel void sort_scatter(__global const Scalar4* records, __global const uint* ids, __global const int* keys,
                           __global int* places, __global Scalar4* sorted, __global uint* sorted_ids,
                           __global Scalar* x, __global Scalar* y, __global Scalar* z, __constant Params* p,
                           int count) {
  int chunk = (int)get_global_id(0);
  int chunks = (int)get_global_size(0);
  __global int* place = places + (size_t)chunk * (p->cell_count + 2);
  int end = chunk_begin(count, chunk + 1, chunks);
  for (int i = chunk_begin(count, chunk, chunks); i < end; ++i) {
    size_t to = (size_t)place[keys[i]]++;
    Scalar4 position = records[2 * (size_t)i];
    sorted[2 * to] = position;
    sorted[2 * to + 1] = records[2 * (size_t)i + 1];
    sorted_ids[to] = ids[i];
    x[to] = position.x;
    y[to] = position.y;
    z[to] = position.z;
  }
}

#endif
