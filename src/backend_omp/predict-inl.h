#pragma once

// Included once per instruction set and precision, after its Pack: what dfsph does between its two solves, and after
// them.

#include "backend_omp/integrate-inl.h"
#include "backend_omp/iteration-inl.h"

namespace squall::openmp {

namespace {

template <class Pack>
struct Prediction {
  Vector<Pack> pushed, smoothed;
};

/// Impulses to start from, viscosity and smoothing, as far as neighbours make them.
template <class Pack, bool viscous, bool smoothing>
Prediction<Pack> predict_from_neighbours(const PassContext<Scalar>& context, const Lanes<Pack>& a, const int* list,
                                         const Scalar* weights, int count) {
  const Params<Scalar>& p = *context.params;
  const Pack x = a.x(), y = a.y(), z = a.z(), vx = a.vx(), vy = a.vy(), vz = a.vz();
  const Pack viscous_scale(p.viscosity_scale * context.substep->kick);
  Prediction<Pack> result;
  for_each_pair<Pack, Weights::far>(context.sorted, list, weights, count, [&](const Record<Scalar>& b, Pack weight) {
    const Pack dx = x - Pack(b.x), dy = y - Pack(b.y), dz = z - Pack(b.z);
    Pack impulse(b.volume_term);
    if constexpr (viscous) {
      const Pack receding = dot_product(dx, dy, dz, vx - Pack(b.vx), vy - Pack(b.vy), vz - Pack(b.vz));
      impulse = viscous_pair_push(impulse, viscous_scale, receding);
    }
    result.pushed.add_scaled(impulse * weight, dx, dy, dz);
    if constexpr (smoothing) {
      const Pack value = bell_value(bell_left(squared_length(dx, dy, dz), Pack(p.inverse_support_squared)));
      result.smoothed.add_scaled(value, Pack(b.vx) - vx, Pack(b.vy) - vy, Pack(b.vz) - vz);
    }
  });
  return result;
}

template <class Pack, bool viscous, bool smoothing>
void predict_block(const PassContext<Scalar>& context, const Block& block, const int* list, const Scalar* weights,
                   int count, Scalar correction) {
  const Params<Scalar>& p = *context.params;
  const Substep<Scalar>& substep = *context.substep;
  const SolveArrays<Scalar>& arrays = context.solve;
  const Lanes<Pack> lanes = own_lanes<Pack>(context.sorted, block);
  const Prediction<Pack> sums = predict_from_neighbours<Pack, viscous, smoothing>(context, lanes, list, weights, count);
  const Pack position[3] = {lanes.x(), lanes.y(), lanes.z()}, impulse = lanes.volume_term();
  const Pack pushed[3] = {sums.pushed.x, sums.pushed.y, sums.pushed.z};
  const Pack smoothed[3] = {sums.smoothed.x, sums.smoothed.y, sums.smoothed.z};
  const Scalar* descents[3] = {arrays.descent_x, arrays.descent_y, arrays.descent_z};
  Pack v[3] = {lanes.vx(), lanes.vy(), lanes.vz()};
  // As add_external_acceleration of the reference: gravity is added to 0, which changes nothing but the sign of zero.
  Pack a[3] = {Pack(0.0f) + Pack(substep.acceleration_x), Pack(0.0f) + Pack(substep.acceleration_y),
               Pack(0.0f) + Pack(substep.acceleration_z)};
  if (context.terms.drag) add_drag(context, block, v, a);
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = fma(Pack(substep.kick), a[axis], v[axis]) +
              fma(Pack(p.force_scale), pushed[axis], impulse * Pack::load(descents[axis] + block.begin));
    if constexpr (smoothing) v[axis] = fma(Pack(p.smoothing_scale * substep.dt), smoothed[axis], v[axis]);
  }
  write_records(block, position, Pack(0.0f), v, context.next);
  store_lanes(arrays.impulse, block, impulse);
  store_lanes(arrays.projected, block, impulse);
  store_lanes(arrays.room, block, density_room(Pack::load(context.density + block.begin), Pack(correction)));
}

template <class Pack>
void drift_block(const PassContext<Scalar>& context, const Block& block, PassResult<Scalar>& result,
                 Maxima<Pack>& maxima, int* key_counts) {
  const Substep<Scalar>& substep = *context.substep;
  const SolveArrays<Scalar>& arrays = context.solve;
  const Lanes<Pack> lanes = own_lanes<Pack>(context.next, block);
  const auto load = [&](const Scalar* values) { return Pack::load(values + block.begin); };
  const Pack start_v[3] = {load(arrays.start_vx), load(arrays.start_vy), load(arrays.start_vz)};
  const Pack from[3] = {lanes.x(), lanes.y(), lanes.z()};
  Pack v[3] = {lanes.vx(), lanes.vy(), lanes.vz()}, to[3], a[3];
  for (int axis = 0; axis < 3; ++axis) {
    a[axis] = (v[axis] - start_v[axis]) * Pack(substep.inverse_kick);
    to[axis] = fma(Pack(substep.dt), v[axis], from[axis]);
  }
  const Pack pressure = load(arrays.impulse) * Pack(substep.inverse_kick);
  finish_block(context, block, from, to, v, a, pressure, result, maxima, key_counts);
}

}  // namespace

}  // namespace squall::openmp
