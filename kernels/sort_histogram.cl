/* Reads:  records, ids. Writes: each particle's cell, the chunk's histogram over cells, the chunk's maxima so far.
   Records tell |v|^2 and |a|^2 of the sub-step before (motion.h): met here, they cost nothing.
   One work-item = one chunk of particles. */
#include "chunks.h"
#include "motion.h"
#include "sort_key.h"

#if SQUALL_LANES > 1

__kernel void sort_histogram(__global const Scalar4* records, __global const uint* ids, __global int* keys,
                             __global int* histograms, __global Scalar2* maxima, __global int* clamps,
                             __constant Params* p, __constant HeldGroup* groups, __global const Substep* substeps,
                             int step, int count) {
  int chunk = (int)get_global_id(0);
  int chunks = (int)get_global_size(0);
  int key_count = p->cell_count + 2;
  __global int* histogram = histograms + (size_t)chunk * key_count;
  for (int key = 0; key < key_count; ++key) histogram[key] = 0;

  int held_count = substeps[step].held_count;
  Scalar2 largest = (Scalar2)(0.0f, 0.0f);
  int end = chunk_begin(count, chunk + 1, chunks);
  for (int i = chunk_begin(count, chunk, chunks); i < end; ++i) {
    Scalar4 position = records[2 * (size_t)i];
    largest = fmax(largest, motion_of(position, records[2 * (size_t)i + 1]));
    int key = sort_key(p, groups, held_count, position, ids[i]);
    keys[i] = key;
    ++histogram[key];
  }
  /* Before the first sub-step the spare fields belong to the frame before. */
  maxima[chunk] = step > 0 ? fmax(maxima[chunk], largest) : (Scalar2)(0.0f, 0.0f);
  if (step == 0 && chunk == 0) *clamps = 0;
}

#endif
