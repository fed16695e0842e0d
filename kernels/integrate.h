/* OpenCL only: gravity, drag, kick, drift and the safety net of one particle. Of each vector, w means nothing. */
#ifndef SQUALL_INTEGRATE_H
#define SQUALL_INTEGRATE_H

#include "boundary.h"
#include "sph_formulas.h"
#include "switches.h"

/* Drag of a drop alone by the midpoint rule: at the speed half a kick from now. */
static inline Scalar4 with_drag(__constant Params* p, __global const Substep* now, Scalar4 a, Scalar4 v,
                                Scalar weight) {
  Scalar half_kick = now->kick * p->one_half;
  Scalar4 wind = (Scalar4)(now->wind_x, now->wind_y, now->wind_z, 0.0f);
  Scalar4 before = v - wind;
  Scalar rate = drag_rate(before.x, before.y, before.z, p->drag_coefficient, weight);
  Scalar4 later = fma((Scalar4)(half_kick), fma((Scalar4)(rate), before, a), before);
  rate = drag_rate(later.x, later.y, later.z, p->drag_coefficient, weight);
  return fma((Scalar4)(rate), later, a);
}

/* Moves the particle on at its velocity; returns SQUALL_CLAMPED, SQUALL_LOST or 0. */
static inline int move(__constant Params* p, __constant Box* boxes, __global const Substep* now, Scalar4* position,
                       Scalar4* velocity) {
  Scalar4 v = *velocity;
  Scalar4 x = fma((Scalar4)(now->dt), v, *position);
  Scalar from[3] = {position->x, position->y, position->z};
  Scalar to[3] = {x.x, x.y, x.z};
  *position = x;
#if SQUALL_BOXES
  int box_count = now->box_count;
#else
  int box_count = 0;
#endif
  if (box_count == 0 && is_inside_container(p, to)) return 0;
  Scalar speed[3] = {v.x, v.y, v.z};
  int event = keep_inside(p, boxes, box_count, from, to, speed);
  *position = (Scalar4)(to[0], to[1], to[2], 0.0f);
  *velocity = (Scalar4)(speed[0], speed[1], speed[2], 0.0f);
  return event;
}

/* Kick and move. */
static inline int integrate(__constant Params* p, __constant Box* boxes, __global const Substep* now, Scalar4 a,
                            Scalar4* position, Scalar4* velocity) {
  *velocity = fma((Scalar4)(now->kick), a, *velocity);
  return move(p, boxes, now, position, velocity);
}

#endif
