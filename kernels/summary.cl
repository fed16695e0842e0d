/* Reads:  records after the last sub-step, densities and neighbour counts, maxima so far (with a work-item per
   particle, one for each index; else one for each chunk), clamps.
   Writes: what the chunk adds to the frame report; sums are integers, exact in any order.
   One work-item = one chunk of particles. */
#include "chunks.h"
#include "grid.h"
#include "motion.h"

__kernel void summary(__global const Scalar4* records, __global const Scalar* densities, __global const int* neighbours,
                      __global const int* cell_start, __global const Scalar2* maxima, __global const int* clamps,
                      __constant Params* p, int statistics, int count, __global ChunkSummary* summaries) {
  int chunk = (int)get_global_id(0);
  int chunks = (int)get_global_size(0);
  int active = cell_start[p->cell_count];
  ChunkSummary sum = {0, 0, 0.0f, 0.0f, 0.0f, 0, 0, 0};
#if SQUALL_LANES > 1
  Scalar2 largest = maxima[chunk];
#else
  Scalar2 largest = (Scalar2)(0.0f, 0.0f);
#endif
  int end = chunk_begin(count, chunk + 1, chunks);
  for (int i = chunk_begin(count, chunk, chunks); i < end; ++i) {
    Scalar4 position = records[2 * (size_t)i];
    largest = fmax(largest, motion_of(position, records[2 * (size_t)i + 1]));
#if SQUALL_LANES == 1
    largest = fmax(largest, maxima[i]);
#endif
    sum.lost += is_lost(position.x);
    if (statistics && i < active) {
      Scalar error = clamp(densities[i] - 1, (Scalar)(0), (Scalar)(1024));
      sum.density_error += convert_long_rte(error * 4294967296.0f); /* 2^32 */
      sum.max_density = fmax(sum.max_density, densities[i]);
      sum.neighbours += neighbours[i];
    }
  }
  sum.max_speed2 = largest.x;
  sum.max_acceleration2 = largest.y;
  if (chunk == 0) {
    sum.active = active;
    sum.clamps = *clamps;
  }
  summaries[chunk] = sum;
}
