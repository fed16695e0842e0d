#pragma once

// Included once per instruction set, after its Pack: kick, drift and the safety net of a block.

#include "backend_omp/block-inl.h"

namespace squall::openmp {

namespace {

/// Adds the drag of air at the speed half a kick from now (midpoint rule) to the accelerations of lone drops.
template <class Pack>
void add_drag(const PassContext& context, const Block& block, const Pack* v, Pack* a) {
  const Substep<float>& substep = *context.substep;
  const Pack weight = Pack::load(context.isolation + block.begin);
  const Pack coefficient(context.params->drag_coefficient);
  const Pack half_kick(substep.kick * context.params->one_half);
  const Pack wind[3] = {Pack(substep.wind_x), Pack(substep.wind_y), Pack(substep.wind_z)};
  Pack now[3], then[3];
  for (int axis = 0; axis < 3; ++axis) now[axis] = v[axis] - wind[axis];
  const Pack rate = drag_rate(now[0], now[1], now[2], coefficient, weight);
  for (int axis = 0; axis < 3; ++axis) then[axis] = fma(half_kick, fma(rate, now[axis], a[axis]), now[axis]);
  const Pack rate_then = drag_rate(then[0], then[1], then[2], coefficient, weight);
  for (int axis = 0; axis < 3; ++axis) a[axis] = fma(rate_then, then[axis], a[axis]);
}

/// Lanes that keep_inside would leave alone: inside the container, and on no way that touches the surroundings of a
/// box.
template <class Pack>
bool all_clear(const PassContext& context, Mask valid, const Pack* from, const Pack* to) {
  const Params<float>& p = *context.params;
  const float sizes[3] = {p.size_x, p.size_y, p.size_z};
  const Pack edge(p.clamp_distance);
  for (int axis = 0; axis < 3; ++axis) {
    const bool open = axis == 1 && p.lid == 0.0f;
    const Pack top(open ? p.size_y + p.lost_distance : sizes[axis] - p.clamp_distance);
    // Written so that NaN is not clear.
    const Mask inside = (edge < to[axis]) & (to[axis] < top);
    if (!all(inside, valid)) return false;
  }
  for (int b = 0; b < context.substep->box_count; ++b) {
    const Box<float>& box = context.boxes[b];
    Mask touched = valid;
    for (int axis = 0; axis < 3; ++axis) {
      touched = touched & (Pack(box.solid_min[axis] - p.clamp_distance) < larger(from[axis], to[axis])) &
                (smaller(from[axis], to[axis]) < Pack(box.solid_max[axis] + p.clamp_distance));
    }
    if (any(touched)) return false;
  }
  return true;
}

/// Puts every particle of the block through keep_inside, one at a time. Returns the lanes that are left, as 0 or 1.
template <class Pack>
Pack keep_block_inside(const PassContext& context, const Block& block, const Pack* from, Pack* x, Pack* v,
                       PassResult& result) {
  alignas(64) float starts[3][Pack::k_lanes], ends[3][Pack::k_lanes], speeds[3][Pack::k_lanes], kept[Pack::k_lanes];
  for (int axis = 0; axis < 3; ++axis) {
    from[axis].store(starts[axis]);
    x[axis].store(ends[axis]);
    v[axis].store(speeds[axis]);
  }
  for (int lane = 0; lane < Pack::k_lanes; ++lane) {
    kept[lane] = lane < block.count() ? 1.0f : 0.0f;
    if (lane >= block.count()) continue;
    const float start[3] = {starts[0][lane], starts[1][lane], starts[2][lane]};
    float end[3] = {ends[0][lane], ends[1][lane], ends[2][lane]};
    float speed[3] = {speeds[0][lane], speeds[1][lane], speeds[2][lane]};
    const int event = keep_inside(context.params, context.boxes, context.substep->box_count, start, end, speed);
    result.clamps += (event & SQUALL_CLAMPED) != 0;
    result.lost += (event & SQUALL_LOST) != 0;
    if ((event & SQUALL_LOST) != 0) kept[lane] = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      ends[axis][lane] = end[axis];
      speeds[axis][lane] = speed[axis];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    x[axis] = Pack::load(ends[axis]);
    v[axis] = Pack::load(speeds[axis]);
  }
  return Pack::load(kept);
}

/// Largest square of a vector over the lanes that are kept.
template <class Pack>
void note_maximum(const Block& block, const float* kept, const Pack* vector, float& maximum) {
  alignas(64) float squares[Pack::k_lanes];
  squared_length(vector[0], vector[1], vector[2]).store(squares);
  for (int lane = 0; lane < block.count(); ++lane)
    if (kept[lane] > 0.0f && squares[lane] > maximum) maximum = squares[lane];
}

template <class Pack>
void integrate_block(const PassContext& context, const Block& block, Pack x, Pack y, Pack z, Pack vx, Pack vy, Pack vz,
                     Pack ax, Pack ay, Pack az, PassResult& result) {
  const Substep<float>& substep = *context.substep;
  const Pack from[3] = {x, y, z};
  Pack to[3] = {x, y, z};
  Pack v[3] = {vx, vy, vz};
  Pack a[3] = {ax + Pack(substep.acceleration_x), ay + Pack(substep.acceleration_y), az + Pack(substep.acceleration_z)};
  if (context.terms.drag) add_drag(context, block, v, a);
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = fma(Pack(substep.kick), a[axis], v[axis]);
    to[axis] = fma(Pack(substep.dt), v[axis], to[axis]);
  }
  Pack kept(1.0f);
  if (!all_clear(context, first_lanes(block.count()), from, to))
    kept = keep_block_inside(context, block, from, to, v, result);

  alignas(64) float kept_lanes[Pack::k_lanes];
  kept.store(kept_lanes);
  note_maximum(block, kept_lanes, v, result.max_speed2);
  note_maximum(block, kept_lanes, a, result.max_acceleration2);

  alignas(64) float positions[3][Pack::k_lanes], speeds[3][Pack::k_lanes];
  for (int axis = 0; axis < 3; ++axis) {
    to[axis].store(positions[axis]);
    v[axis].store(speeds[axis]);
  }
  for (int lane = 0; lane < block.count(); ++lane)
    context.next[block.begin + lane] = {positions[0][lane], positions[1][lane], positions[2][lane], 0.0f,
                                        speeds[0][lane],    speeds[1][lane],    speeds[2][lane],    0.0f};
}

}  // namespace

}  // namespace squall::openmp
