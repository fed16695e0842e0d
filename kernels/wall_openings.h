/* OpenCL only, for dfsph: the open share of a particle's support with the walls' cores, and its gradient (1/m). Density
   and force take the same. */
#ifndef SQUALL_WALL_OPENINGS_H
#define SQUALL_WALL_OPENINGS_H

#include "switches.h"
#include "wall_cores.h"
#include "walls.h"

static inline Real opening_with_cores(__constant Params* p, __constant Box* boxes, int box_count, Real x, Real y,
                                      Real z, Real* gx, Real* gy, Real* gz) {
  Real open = container_opening(p, SQUALL_BELL, (Real)(p->density_wall_shift), x, y, z, gx, gy, gz);
#if SQUALL_BOXES
  for (int b = 0; b < box_count; ++b)
    open = close_box(p, SQUALL_BELL, boxes[b].density_min, boxes[b].density_max, x, y, z, open, gx, gy, gz);
#endif
  open = close_container_cores(p, x, y, z, open, gx, gy, gz);
#if SQUALL_BOXES
  for (int b = 0; b < box_count; ++b) open = close_box_core(p, boxes + b, x, y, z, open, gx, gy, gz);
#endif
  return open;
}

#endif
