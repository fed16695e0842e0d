/* Reads:  bins, arrivals, where bins start. Writes: each bin's members by their old indices, in the order in which they
   happened to come.
   One work-item = one particle. */
#include "sort_bins.h"

#if SQUALL_LANES == 1

__kernel void sort_members(__global const int* bins, __global const int* arrivals, __global const int* starts,
                           __global int* members, int count) {
  int i = (int)get_global_id(0);
  if (i >= count) return;
  members[starts[bins[i]] + arrivals[i]] = i;
}

#endif
