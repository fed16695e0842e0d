#pragma once

// Included once per instruction set and precision, after its Pack: kick, drift and the safety net of a block.

#include <algorithm>

#include "backend_omp/forces-inl.h"

namespace squall::openmp {

namespace {

/// Adds the drag of air at the speed half a kick from now (midpoint rule) to the accelerations of lone drops.
template <class Pack>
void add_drag(const PassContext<Scalar>& context, const Block& block, const Pack* v, Pack* a) {
  const Substep<Scalar>& substep = *context.substep;
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
bool all_clear(const PassContext<Scalar>& context, Mask valid, const Pack* from, const Pack* to) {
  const Params<Scalar>& p = *context.params;
  const Pack edge(p.clamp_distance);
  const Scalar top = p.lid == 0.0f ? p.size_y + p.lost_distance : p.size_y - p.clamp_distance;
  const Scalar far_sides[3] = {p.size_x - p.clamp_distance, top, p.size_z - p.clamp_distance};
  Mask inside = valid;
  for (int axis = 0; axis < 3; ++axis)  // written so that NaN is not inside
    inside = inside & (edge < to[axis]) & (to[axis] < Pack(far_sides[axis]));
  if (!all(inside, valid)) return false;
  for (int b = 0; b < context.substep->box_count; ++b) {
    const Box<Scalar>& box = context.boxes[b];
    Mask touched = valid;
    for (int axis = 0; axis < 3; ++axis) {
      touched = touched & (Pack(box.solid_min[axis] - p.clamp_distance) < larger(from[axis], to[axis])) &
                (smaller(from[axis], to[axis]) < Pack(box.solid_max[axis] + p.clamp_distance));
    }
    if (any(touched)) return false;
  }
  return true;
}

/// Puts every particle of the block through keep_inside, one at a time. Returns the lanes that are not lost.
template <class Pack>
Mask keep_block_inside(const PassContext<Scalar>& context, const Block& block, const Pack* from, Pack* x, Pack* v,
                       PassResult<Scalar>& result) {
  alignas(64) Scalar starts[3][Pack::k_lanes], ends[3][Pack::k_lanes], speeds[3][Pack::k_lanes], kept[Pack::k_lanes];
  for (int axis = 0; axis < 3; ++axis) {
    from[axis].store(starts[axis]);
    x[axis].store(ends[axis]);
    v[axis].store(speeds[axis]);
  }
  for (int lane = 0; lane < Pack::k_lanes; ++lane) {
    kept[lane] = lane < block.count() ? 1.0f : 0.0f;
    if (lane >= block.count()) continue;
    const Scalar start[3] = {starts[0][lane], starts[1][lane], starts[2][lane]};
    Scalar end[3] = {ends[0][lane], ends[1][lane], ends[2][lane]};
    Scalar speed[3] = {speeds[0][lane], speeds[1][lane], speeds[2][lane]};
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
  return Pack(0.0f) < Pack::load(kept);
}

/// Largest squares of velocity and acceleration of what a thread has moved, lane by lane.
template <class Pack>
struct Maxima {
  Pack speed2{0.0f}, acceleration2{0.0f};

  void note(Mask lanes, const Pack* v, const Pack* a) {
    speed2 = larger(speed2, select(lanes, squared_length(v[0], v[1], v[2]), Pack(0.0f)));
    acceleration2 = larger(acceleration2, select(lanes, squared_length(a[0], a[1], a[2]), Pack(0.0f)));
  }
  void report(PassResult<Scalar>& result) const {
    result.max_speed2 = std::max(result.max_speed2, first_lane(largest_lane(speed2)));
    result.max_acceleration2 = std::max(result.max_acceleration2, first_lane(largest_lane(acceleration2)));
  }
};

/// Writes the block's records; none behind its end, which may be another thread's.
template <class Pack>
void write_records(const Block& block, const Pack* position, Pack pressure, const Pack* velocity,
                   Record<Scalar>* next) {
  const Pack zero(0.0f);
  const Pack fields[8] = {position[0], position[1], position[2], pressure, velocity[0], velocity[1], velocity[2], zero};
  Record<Scalar> part[Pack::k_lanes];
  const bool full = block.count() == Pack::k_lanes;
  auto* to = reinterpret_cast<Scalar*>(full ? next + block.begin : part);
  store_fields(to, 0, fields);
  store_fields(to, 4, fields + 4);
  if (!full) std::copy(part, part + block.count(), next + block.begin);
}

/// Notes in which cell each particle of the block is now; what is not in `kept` is lost.
template <class Pack>
void write_keys(const PassContext<Scalar>& context, const Block& block, const Pack* position, Mask kept,
                int* key_counts) {
  const Params<Scalar>& p = *context.params;
  const auto x = cell_coordinates(position[0], p.inverse_edge_x, p.cells_x);
  const auto y = cell_coordinates(position[1], p.inverse_edge_yz, p.cells_y);
  const auto z = cell_coordinates(position[2], p.inverse_edge_yz, p.cells_z);
  alignas(64) int keys[Pack::k_lanes];
  select(kept, combine(combine(z, p.cells_y, y), p.cells_x, x), lost_cell(&p)).store(keys);
  for (int lane = 0; lane < block.count(); ++lane) {
    context.next_keys[block.begin + lane] = keys[lane];
    ++key_counts[keys[lane]];
  }
}

/// The end of a sub-step: safety net, maxima, records and keys of what went `from` somewhere `to` somewhere.
template <class Pack>
void finish_block(const PassContext<Scalar>& context, const Block& block, const Pack* from, Pack* to, Pack* v,
                  const Pack* a, Pack pressure, PassResult<Scalar>& result, Maxima<Pack>& maxima, int* key_counts) {
  Mask kept = first_lanes(block.count());
  if (!all_clear(context, kept, from, to)) kept = kept & keep_block_inside(context, block, from, to, v, result);
  maxima.note(kept, v, a);
  write_records(block, to, pressure, v, context.next);
  write_keys(context, block, to, kept, key_counts);
}

template <class Pack>
void integrate_block(const PassContext<Scalar>& context, const Block& block, const Lanes<Pack>& at,
                     const Vector<Pack>& force, PassResult<Scalar>& result, Maxima<Pack>& maxima, int* key_counts) {
  const Substep<Scalar>& substep = *context.substep;
  const Pack from[3] = {at.x(), at.y(), at.z()};
  Pack to[3] = {at.x(), at.y(), at.z()};
  Pack v[3] = {at.vx(), at.vy(), at.vz()};
  Pack a[3] = {force.x + Pack(substep.acceleration_x), force.y + Pack(substep.acceleration_y),
               force.z + Pack(substep.acceleration_z)};
  if (context.terms.drag) add_drag(context, block, v, a);
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = fma(Pack(substep.kick), a[axis], v[axis]);
    to[axis] = fma(Pack(substep.dt), v[axis], to[axis]);
  }
  finish_block(context, block, from, to, v, a, Pack(0.0f), result, maxima, key_counts);
}

}  // namespace

}  // namespace squall::openmp
