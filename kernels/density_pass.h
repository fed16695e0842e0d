/* OpenCL only: density of one particle and what its neighbours need of it. Two kernels share it: density.cl, and
   density_statistics.cl for the sub-step that the frame report describes. */
#ifndef SQUALL_DENSITY_PASS_H
#define SQUALL_DENSITY_PASS_H

#include "neighbour_rows.h"
#include "openings.h"

typedef struct {
  Scalar even, odd; /* kernel sums by the parity of the sorted index */
  int neighbours;   /* self included */
} KernelSum;

static inline void add_candidate(__constant Params* p, Scalar4 from, Scalar4 to, int j, KernelSum* sum) {
  Scalar x = from.x - to.x, y = from.y - to.y, z = from.z - to.z;
#if SQUALL_WCSPH
  Scalar r2 = squared_length(x, y, z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  Scalar r = sqrt(r2);
  Scalar reach = remaining_support(r, p->inverse_support);
  Scalar value = cubic_value(reach, remaining_support(r, p->inverse_half_support));
#else
  Scalar reach = squared_support_left(x, y, z, p->support_squared);
  Scalar value = poly6_value(reach);
#endif
  if (j & 1)
    sum->odd += value;
  else
    sum->even += value;
  sum->neighbours += reach > 0.0f;
}

/* Returns the number of neighbours within H. Of `places`, w means nothing; of the records, only the spare fields are
   written, and nothing is read. */
static inline int density_pass(__global const Scalar4* places, __global Scalar* records, __global Scalar* densities,
                               __global Scalar* isolations, __global const int* cell_start, __constant Params* p,
                               __constant Box* boxes, int box_count, int i) {
  Scalar4 at = places[i];
  Neighbourhood cells = neighbourhood(p, at.x, at.y, at.z);
  KernelSum sum = {0.0f, 0.0f, 0};
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) add_candidate(p, at, places[j], j, &sum);
    }
  }
  Scalar kernel_sum = sum.even + sum.odd;
  Scalar share = 1 - density_opening(p, boxes, box_count, at.x, at.y, at.z);
  Scalar density = relative_density(kernel_sum, p->density_scale, share);
#if SQUALL_WCSPH
  Scalar volume_term = 1 / density;
  Scalar pressure_term = tait_pressure(density, p->stiffness) / (density * density);
#else
  Scalar volume_term = p->one_half / density;
  Scalar pressure_term = mueller_pressure(density, p->stiffness, p->tension) * volume_term;
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
