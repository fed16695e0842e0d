/* OpenCL only: density of one particle and what its neighbours need of it. Two kernels share it: density.cl, and
   density_statistics.cl for the sub-step that the frame report describes. */
#ifndef SQUALL_DENSITY_PASS_H
#define SQUALL_DENSITY_PASS_H

#include "neighbour_rows.h"
#include "openings.h"

typedef struct {
  float even, odd; /* kernel sums by the parity of the sorted index */
  int neighbours;  /* self included */
} KernelSum;

static inline void add_candidate(__constant Params* p, float4 from, float4 to, int j, KernelSum* sum) {
  float x = from.x - to.x, y = from.y - to.y, z = from.z - to.z;
#if SQUALL_WCSPH
  float r2 = squared_length(x, y, z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  float r = sqrt(r2);
  float reach = remaining_support(r, p->inverse_support);
  float value = cubic_value(reach, remaining_support(r, p->inverse_half_support));
#else
  float reach = squared_support_left(x, y, z, p->support_squared);
  float value = poly6_value(reach);
#endif
  if (j & 1)
    sum->odd += value;
  else
    sum->even += value;
  sum->neighbours += reach > 0.0f;
}

/* Returns the number of neighbours within H. Of `places`, w means nothing; of the records, only the spare fields are
   written, and nothing is read. */
static inline int density_pass(__global const float4* places, __global float* records, __global float* densities,
                               __global float* isolations, __global const int* cell_start, __constant Params* p,
                               __constant Box* boxes, int box_count, int i) {
  float4 at = places[i];
  Neighbourhood cells = neighbourhood(p, at.x, at.y, at.z);
  KernelSum sum = {0.0f, 0.0f, 0};
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) add_candidate(p, at, places[j], j, &sum);
    }
  }
  float kernel_sum = sum.even + sum.odd;
  float share = 1 - density_opening(p, boxes, box_count, at.x, at.y, at.z);
  float density = relative_density(kernel_sum, p->density_scale, share);
#if SQUALL_WCSPH
  float volume_term = 1 / density;
  float pressure_term = tait_pressure(density, p->stiffness) / (density * density);
#else
  float volume_term = p->one_half / density;
  float pressure_term = mueller_pressure(density, p->stiffness, p->tension) * volume_term;
#endif
  records[8 * (size_t)i + 3] = pressure_term;
  records[8 * (size_t)i + 7] = volume_term;
  densities[i] = density;
#if SQUALL_DRAG
  isolations[i] = isolation(kernel_sum, p->self_value, p->density_scale, share, p->steepness);
#endif
  return sum.neighbours - 1;
}

#endif
