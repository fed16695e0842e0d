/* Reads:  records, ids. Writes: each particle's bin and how many came to that bin before it; counts each bin's members,
   which were zero; the largest |v|^2 and |a|^2 of the frame so far at this index (forces.cl leaves those of the
   sub-step before in the records' spare fields: met here, they cost nothing).
   One work-item = one particle. */
#include "motion.h"
#include "sort_bins.h"

#if SQUALL_LANES == 1

__kernel void sort_count(__global const Scalar4* records, __global const uint* ids, __global int* bins,
                         __global int* arrivals, __global int* counts, __global Scalar2* maxima, __global int* clamps,
                         __constant Params* p, __constant HeldGroup* groups, __global const Substep* substeps,
                         int blocks, int step, int count) {
  int i = (int)get_global_id(0);
  if (step == 0 && i == 0) *clamps = 0;
  if (i >= count) return;
  Scalar4 position = records[2 * (size_t)i];
  Scalar2 largest = motion_of(position, records[2 * (size_t)i + 1]);
  /* Before the first sub-step the spare fields belong to the frame before. */
  maxima[i] = step > 0 ? fmax(maxima[i], largest) : (Scalar2)(0.0f, 0.0f);
  int bin = bin_of(p, sort_key(p, groups, substeps[step].held_count, position, ids[i]), i, blocks);
  bins[i] = bin;
  arrivals[i] = atomic_inc(counts + bin);
}

#endif
