/* The safety net behind the wall forces: puts back, one particle at a time, what has crossed a wall, and marks what is
   lost. Scalar code with branches: it runs on few particles. */
#ifndef SQUALL_BOUNDARY_H
#define SQUALL_BOUNDARY_H

#include "params.h"

#define SQUALL_CLAMPED 1
#define SQUALL_LOST 2

SQUALL_NAMESPACE_BEGIN

/* Keeps a coordinate within [low, high] and stops the motion that leads out. */
SQUALL_SCALAR_FORMULA int clamp_axis(Scalar low, Scalar high, Scalar* x, Scalar* v) {
  if (*x < low) {
    *x = low;
    if (*v < (Scalar)(0)) *v = (Scalar)(0);
    return SQUALL_CLAMPED;
  }
  if (*x > high) {
    *x = high;
    if (*v > (Scalar)(0)) *v = (Scalar)(0);
    return SQUALL_CLAMPED;
  }
  return 0;
}

/* Narrows [*enter, *leave] to the part of the way from `from` to `to` (0..1) that lies strictly between low and high;
   notes the axis that is entered last. Returns 0 if the way misses the slab. */
SQUALL_SCALAR_FORMULA int clip_way(Scalar from, Scalar to, Scalar low, Scalar high, int axis, Scalar* enter,
                                   Scalar* leave, int* entry_axis) {
  Scalar way = to - from;
  if (way == (Scalar)(0)) return from > low && from < high;
  Scalar near = (way > (Scalar)(0) ? low - from : high - from) / way;
  Scalar far = (way > (Scalar)(0) ? high - from : low - from) / way;
  if (near >= *enter) {
    *enter = near;
    *entry_axis = axis;
  }
  if (far < *leave) *leave = far;
  return *enter < *leave;
}

/* Keeps a particle that moved from `from` to `x` out of a solid box: stopped at the face it crossed, however fast and
   however thin the box; one that was inside already leaves through the nearest face. */
SQUALL_SCALAR_FORMULA int keep_out_of_box(SQUALL_CONSTANT SQUALL_REF(Box) * box, Scalar margin, const Scalar* from,
                                          Scalar* x, Scalar* v) {
  Scalar low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = box->solid_min[axis] - margin;
    high[axis] = box->solid_max[axis] + margin;
  }
  Scalar enter = (Scalar)(-1);
  Scalar leave = (Scalar)(1);
  int entry_axis = -1;
  for (int axis = 0; axis < 3; ++axis)
    if (!clip_way(from[axis], x[axis], low[axis], high[axis], axis, &enter, &leave, &entry_axis)) return 0;
  if (leave <= (Scalar)(0)) return 0;
  if (enter < (Scalar)(0) || entry_axis < 0) { /* it was inside before */
    if (!(x[0] > low[0] && x[0] < high[0] && x[1] > low[1] && x[1] < high[1] && x[2] > low[2] && x[2] < high[2]))
      return 0;
    Scalar nearest = high[0] - low[0];
    for (int axis = 0; axis < 3; ++axis) {
      if (x[axis] - low[axis] <= nearest) {
        nearest = x[axis] - low[axis];
        entry_axis = axis;
      }
      if (high[axis] - x[axis] <= nearest) {
        nearest = high[axis] - x[axis];
        entry_axis = axis;
      }
    }
    if (entry_axis < 0) entry_axis = 0;
    if (x[entry_axis] - low[entry_axis] <= high[entry_axis] - x[entry_axis]) {
      x[entry_axis] = low[entry_axis];
      if (v[entry_axis] > (Scalar)(0)) v[entry_axis] = (Scalar)(0);
    } else {
      x[entry_axis] = high[entry_axis];
      if (v[entry_axis] < (Scalar)(0)) v[entry_axis] = (Scalar)(0);
    }
    return SQUALL_CLAMPED;
  }
  x[entry_axis] = x[entry_axis] > from[entry_axis] ? low[entry_axis] : high[entry_axis];
  v[entry_axis] = (Scalar)(0);
  return SQUALL_CLAMPED;
}

/* Finite and nearer than the lost distance on every side; false for NaN. */
SQUALL_SCALAR_FORMULA int is_kept(SQUALL_CONSTANT SQUALL_REF(Params) * p, const Scalar* x) {
  Scalar reach = p->lost_distance;
  return x[0] >= -reach && x[0] <= p->size_x + reach && x[1] >= -reach && x[1] <= p->size_y + reach && x[2] >= -reach &&
         x[2] <= p->size_z + reach;
}

/* Nothing to do for a particle here: inside the container by more than the clamp distance. False for NaN. */
SQUALL_SCALAR_FORMULA int is_inside_container(SQUALL_CONSTANT SQUALL_REF(Params) * p, const Scalar* x) {
  Scalar edge = p->clamp_distance;
  Scalar top = p->lid > (Scalar)(0) ? p->size_y - edge : p->size_y + p->lost_distance;
  return x[0] >= edge && x[0] <= p->size_x - edge && x[1] >= edge && x[1] <= top && x[2] >= edge &&
         x[2] <= p->size_z - edge;
}

/* After the drift from `from` to `x`: marks the lost, keeps the rest out of boxes and inside the container. */
SQUALL_SCALAR_FORMULA int keep_inside(SQUALL_CONSTANT SQUALL_REF(Params) * p, SQUALL_CONSTANT SQUALL_REF(Box) * boxes,
                                      int box_count, const Scalar* from, Scalar* x, Scalar* v) {
  if (!is_kept(p, x)) {
    for (int axis = 0; axis < 3; ++axis) {
      x[axis] = (Scalar)(SQUALL_LOST_COORDINATE);
      v[axis] = (Scalar)(0);
    }
    return SQUALL_LOST;
  }
  int result = 0;
  for (int b = 0; b < box_count; ++b) result |= keep_out_of_box(boxes + b, p->clamp_distance, from, x, v);
  Scalar edge = p->clamp_distance;
  Scalar top = p->lid > (Scalar)(0) ? p->size_y - edge : p->size_y + p->lost_distance;
  result |= clamp_axis(edge, p->size_x - edge, x + 0, v + 0);
  result |= clamp_axis(edge, top, x + 1, v + 1);
  result |= clamp_axis(edge, p->size_z - edge, x + 2, v + 2);
  return result;
}

SQUALL_NAMESPACE_END

#endif
