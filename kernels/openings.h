/* OpenCL only: the open share of a particle's support, container and standing boxes together, and its gradient (1/m).
   Once for the walls as density sees them, once as forces see them. */
#ifndef SQUALL_OPENINGS_H
#define SQUALL_OPENINGS_H

#include "switches.h"
#include "walls.h"

static inline Real density_opening(__constant Params* p, __constant Box* boxes, int box_count, Real x, Real y, Real z) {
  Real gx, gy, gz;
  Real open = container_opening(p, SQUALL_DENSITY_KERNEL, (Real)(p->density_wall_shift), x, y, z, &gx, &gy, &gz);
#if SQUALL_BOXES
  for (int b = 0; b < box_count; ++b)
    open =
        close_box(p, SQUALL_DENSITY_KERNEL, boxes[b].density_min, boxes[b].density_max, x, y, z, open, &gx, &gy, &gz);
#endif
  return open;
}

static inline void force_opening(__constant Params* p, __constant Box* boxes, int box_count, Real x, Real y, Real z,
                                 Real* gx, Real* gy, Real* gz) {
  Real open = container_opening(p, SQUALL_FORCE_KERNEL, (Real)(p->force_wall_shift), x, y, z, gx, gy, gz);
#if SQUALL_BOXES
  for (int b = 0; b < box_count; ++b)
    open = close_box(p, SQUALL_FORCE_KERNEL, boxes[b].force_min, boxes[b].force_max, x, y, z, open, gx, gy, gz);
#endif
}

#endif
