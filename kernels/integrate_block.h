/* OpenCL only, for CPU devices: gravity, drag, kick, drift and the safety net of a block of particles. */
#ifndef SQUALL_INTEGRATE_BLOCK_H
#define SQUALL_INTEGRATE_BLOCK_H

#include "block_sums.h"
#include "boundary.h"

/* Adds the drag of lone drops, by the midpoint rule: at the speed half a kick from now. */
static inline void add_drag(__constant Params* p, __global const Substep* now, const Block* block, const Lanes* at,
                            __global const Scalar* isolations, Vector* a) {
  Real weight = gather_value(isolations, block);
  Real coefficient = (Real)(p->drag_coefficient);
  Real half_kick = (Real)(now->kick * p->one_half);
  Real x = at->vx - (Real)(now->wind_x), y = at->vy - (Real)(now->wind_y), z = at->vz - (Real)(now->wind_z);
  Real rate = drag_rate(x, y, z, coefficient, weight);
  x = fma(half_kick, fma(rate, x, a->x), x);
  y = fma(half_kick, fma(rate, y, a->y), y);
  z = fma(half_kick, fma(rate, z, a->z), z);
  rate = drag_rate(x, y, z, coefficient, weight);
  a->x = fma(rate, x, a->x);
  a->y = fma(rate, y, a->y);
  a->z = fma(rate, z, a->z);
}

/* Whether every lane is inside the container by more than the clamp distance; NaN is not. */
static inline int all_inside(__constant Params* p, const Vector* x) {
  Real edge = (Real)(p->clamp_distance);
  Real top = (Real)(p->lid > 0.0f ? p->size_y - p->clamp_distance : p->size_y + p->lost_distance);
  Mask inside = (x->x >= edge) & (x->x <= (Real)(p->size_x - p->clamp_distance)) & (x->y >= edge) & (x->y <= top) &
                (x->z >= edge) & (x->z <= (Real)(p->size_z - p->clamp_distance));
  return !any_lane(~inside);
}

/* Puts lane `lane` through keep_inside. */
static inline int keep_lane_inside(__constant Params* p, __constant Box* boxes, int box_count, int lane,
                                   const Scalar (*from_lanes)[SQUALL_LANES], Scalar (*to_lanes)[SQUALL_LANES],
                                   Scalar (*speed_lanes)[SQUALL_LANES]) {
  Scalar from[3], to[3], speed[3];
  for (int axis = 0; axis < 3; ++axis) {
    from[axis] = from_lanes[axis][lane];
    to[axis] = to_lanes[axis][lane];
    speed[axis] = speed_lanes[axis][lane];
  }
  int event = keep_inside(p, boxes, box_count, from, to, speed);
  for (int axis = 0; axis < 3; ++axis) {
    to_lanes[axis][lane] = to[axis];
    speed_lanes[axis][lane] = speed[axis];
  }
  return event;
}

/* What stays in the spare fields of a record: see motion.h. */
static inline Scalar8 moved_record(const Scalar* to, const Scalar* v, int lost, Scalar pressure, Scalar acceleration2) {
#if SQUALL_DFSPH
  return (Scalar8)(to[0], to[1], to[2], pressure, v[0], v[1], v[2], lost ? -1.0f : acceleration2);
#else
  Scalar speed2 = fma(v[2], v[2], fma(v[1], v[1], v[0] * v[0]));
  return (Scalar8)(to[0], to[1], to[2], lost ? 0.0f : speed2, v[0], v[1], v[2], lost ? 0.0f : acceleration2);
#endif
}

/* Moves a block that is at `at` on with velocity v, and writes its records. The pressure is dfsph's. */
static inline void move_block(__constant Params* p, __constant Box* boxes, __global const Substep* now,
                              const Block* block, const Lanes* at, const Vector* a, const Vector* velocity,
                              Real pressure, __global Scalar* records, __global int* clamps) {
  Real dt = (Real)(now->dt);
  Vector v = *velocity;
  Vector x = {fma(dt, v.x, at->x), fma(dt, v.y, at->y), fma(dt, v.z, at->z)};
  Scalar from_lanes[3][SQUALL_LANES], to_lanes[3][SQUALL_LANES], speed_lanes[3][SQUALL_LANES];
  Scalar acceleration2[SQUALL_LANES], pressures[SQUALL_LANES];
  store_lanes(x.x, to_lanes[0]);
  store_lanes(x.y, to_lanes[1]);
  store_lanes(x.z, to_lanes[2]);
  store_lanes(v.x, speed_lanes[0]);
  store_lanes(v.y, speed_lanes[1]);
  store_lanes(v.z, speed_lanes[2]);
  store_lanes(squared_length(a->x, a->y, a->z), acceleration2);
  store_lanes(pressure, pressures);
#if SQUALL_BOXES
  int box_count = now->box_count;
#else
  int box_count = 0;
#endif
  int lost[SQUALL_LANES] = {0};
  if (box_count > 0 || !all_inside(p, &x)) {
    int clamped = 0;
    store_lanes(at->x, from_lanes[0]);
    store_lanes(at->y, from_lanes[1]);
    store_lanes(at->z, from_lanes[2]);
    for (int lane = 0; lane < block->end - block->begin; ++lane) {
      int event =
          keep_lane_inside(p, boxes, box_count, lane, (const Scalar(*)[SQUALL_LANES])from_lanes, to_lanes, speed_lanes);
      lost[lane] = event & SQUALL_LOST;
      clamped += (event & SQUALL_CLAMPED) != 0;
    }
    if (clamped) atomic_add(clamps, clamped);
  }
  for (int i = block->begin; i < block->end; ++i) {
    int lane = i - block->begin;
    Scalar to[3] = {to_lanes[0][lane], to_lanes[1][lane], to_lanes[2][lane]};
    Scalar speed[3] = {speed_lanes[0][lane], speed_lanes[1][lane], speed_lanes[2][lane]};
    vstore8(moved_record(to, speed, lost[lane], pressures[lane], acceleration2[lane]), i, records);
  }
}

static inline void integrate_block(__constant Params* p, __constant Box* boxes, __global const Substep* now,
                                   const Block* block, const Lanes* at, Vector* a, __global const Scalar* isolations,
                                   __global Scalar* records, __global int* clamps) {
  a->x += (Real)(now->acceleration_x);
  a->y += (Real)(now->acceleration_y);
  a->z += (Real)(now->acceleration_z);
#if SQUALL_DRAG
  add_drag(p, now, block, at, isolations, a);
#endif
  Real kick = (Real)(now->kick);
  Vector v = {fma(kick, a->x, at->vx), fma(kick, a->y, at->vy), fma(kick, a->z, at->vz)};
  move_block(p, boxes, now, block, at, a, &v, (Real)(0), records, clamps);
}

#endif
