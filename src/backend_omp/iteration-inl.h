#pragma once

// Included once per instruction set and precision, after its Pack: dfsph's light passes, which walk lists with the
// weights of their pairs. A pair costs a load of each value of the neighbour, of its weight, and little else.

#include <algorithm>
#include <cstddef>

#include "backend_omp/forces-inl.h"
#include "dfsph_formulas.h"

namespace squall::openmp {

namespace {

/// The records of a block and nothing of those behind it, which may be another thread's and be written.
template <class Pack>
Lanes<Pack> own_lanes(const Record<Scalar>* records, const Block& block) {
  if (block.count() == Pack::k_lanes) return Lanes<Pack>(records, block.begin);
  Record<Scalar> part[Pack::k_lanes] = {};
  std::copy(records + block.begin, records + block.end, part);
  return Lanes<Pack>(part, 0);
}

enum class Weights { near, far };  ///< in a near cache, or perhaps not

/// Calls visit(neighbour, weight) for a list, two to a round: the loop itself is a tenth of a light pass. Weights from
/// far away are asked for eight rounds before; where neighbours are, is looked up a round before, so that what waits
/// for them in the processor's vector unit waits less. Looks up two entries behind the list.
template <class Pack, Weights weights_are, class Visit>
SQUALL_INLINE void for_each_pair(const Record<Scalar>* records, const int* list, const Scalar* weights, int count,
                                 Visit visit) {
  const Record<Scalar>*first = records + list[0], *second = records + list[1];
  int k = 0;
  for (; k + 1 < count; k += 2, weights += 2 * Pack::k_lanes) {
    if constexpr (weights_are == Weights::far) prefetch(weights, 16 * Pack::k_lanes);
    const Record<Scalar>*next_first = records + list[k + 2], *next_second = records + list[k + 3];
    visit(*first, Pack::load(weights));
    visit(*second, Pack::load(weights + Pack::k_lanes));
    first = next_first;
    second = next_second;
  }
  if (k < count) visit(*first, Pack::load(weights));
}

/// Sum of weight (v_j.x_ij) over a list. Like the other loops over lists a function of its own, which has all
/// registers.
template <class Pack>
SQUALL_NOINLINE Pack approaching_sum(const Record<Scalar>* records, const Lanes<Pack>& a, const int* list,
                                     const Scalar* weights, int count) {
  const Pack x = a.x(), y = a.y(), z = a.z();
  Pack sum(0.0f);
  for_each_pair<Pack, Weights::far>(records, list, weights, count, [&](const Record<Scalar>& b, Pack weight) {
    const Pack approaching =
        dot_product(x - Pack(b.x), y - Pack(b.y), z - Pack(b.z), Pack(b.vx), Pack(b.vy), Pack(b.vz));
    sum = fma(weight, approaching, sum);
  });
  return sum;
}

/// Sum of weight change_j x_ij over a list.
template <class Pack>
SQUALL_NOINLINE Vector<Pack> pushed_sum(const Record<Scalar>* records, const Lanes<Pack>& a, const int* list,
                                        const Scalar* weights, int count) {
  const Pack x = a.x(), y = a.y(), z = a.z();
  Vector<Pack> sum;
  for_each_pair<Pack, Weights::far>(records, list, weights, count, [&](const Record<Scalar>& b, Pack weight) {
    sum.add_scaled(Pack(b.pressure_term) * weight, x - Pack(b.x), y - Pack(b.y), z - Pack(b.z));
  });
  return sum;
}

/// A block's part of an iteration, `sum` being its approaching_sum: by how much its impulses change, for all to read.
/// Returns the sum of its errors.
template <class Pack>
std::int64_t iterate_block(const PassContext<Scalar>& context, const Block& block, const Lanes<Pack>& a, Pack sum,
                           Scalar momentum) {
  const Params<Scalar>& p = *context.params;
  const Substep<Scalar>& substep = *context.substep;
  const SolveArrays<Scalar>& arrays = context.solve;
  const auto load = [&](const Scalar* values) { return Pack::load(values + block.begin); };
  const Pack along =
      dot_product(a.vx(), a.vy(), a.vz(), load(arrays.descent_x), load(arrays.descent_y), load(arrays.descent_z));
  const Pack dt(substep.dt), impulse = load(arrays.impulse), inverse = load(arrays.inverse_response);
  const Pack lack = lack_of_compression(load(arrays.room), dt, compression_rate(sum, Pack(p.force_scale), along));
  const Pack projected = projected_impulse(impulse, lack, Pack(substep.relaxation_rate), inverse);
  alignas(64) Scalar changes[Pack::k_lanes];
  (extrapolated_impulse(projected, load(arrays.projected), Pack(momentum)) - impulse).store(changes);
  store_lanes(arrays.projected, block, projected);
  for (int lane = 0; lane < block.count(); ++lane) context.sorted[block.begin + lane].pressure_term = changes[lane];
  return sum_of_terms(solve_error(lack, impulse, dt, load(arrays.response), inverse), first_lanes(block.count()));
}

/// Writes velocities into the block's records, and what is behind them.
template <class Pack>
void write_velocities(const PassContext<Scalar>& context, const Block& block, Pack vx, Pack vy, Pack vz, Pack last) {
  const Pack fields[4] = {vx, vy, vz, last};
  if (block.count() == Pack::k_lanes) {
    store_fields(reinterpret_cast<Scalar*>(context.sorted + block.begin), 4, fields);
    return;
  }
  Record<Scalar> part[Pack::k_lanes];
  store_fields(reinterpret_cast<Scalar*>(part), 4, fields);
  for (int lane = 0; lane < block.count(); ++lane) {
    Record<Scalar>& record = context.sorted[block.begin + lane];
    record.vx = part[lane].vx;
    record.vy = part[lane].vy;
    record.vz = part[lane].vz;
    record.volume_term = part[lane].volume_term;
  }
}

/// Velocities of a block after every particle's change of impulse.
template <class Pack>
void push_block(const PassContext<Scalar>& context, const Block& block, const int* list, const Scalar* weights,
                int count) {
  const SolveArrays<Scalar>& arrays = context.solve;
  const Lanes<Pack> lanes = own_lanes<Pack>(context.sorted, block);
  const Pack change = lanes.pressure_term();
  const Vector<Pack> sum = pushed_sum<Pack>(context.sorted, lanes, list, weights, count);
  const Pack scale(context.params->force_scale);
  const auto pushed = [&](Pack v, Pack push, const Scalar* descent) {
    return v + fma(scale, push, change * Pack::load(descent + block.begin));
  };
  write_velocities(context, block, pushed(lanes.vx(), sum.x, arrays.descent_x),
                   pushed(lanes.vy(), sum.y, arrays.descent_y), pushed(lanes.vz(), sum.z, arrays.descent_z),
                   lanes.volume_term());
  store_lanes(arrays.impulse, block, max0(Pack::load(arrays.impulse + block.begin) + change));
}

}  // namespace

}  // namespace squall::openmp
