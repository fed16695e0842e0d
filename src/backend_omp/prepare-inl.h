#pragma once

// Included once per instruction set and precision, after its Pack: how dfsph finds neighbours, their weights, and what
// the solves need of each particle.

#include "backend_omp/iteration-inl.h"
#include "backend_omp/neighbours-inl.h"
#include "wall_cores.h"

namespace squall::openmp {

namespace {

/// Walls near a block, with their cores: what dfsph takes for density and force.
template <class Pack>
Opening<Pack> opening_with_cores(const PassContext<Scalar>& context, Mask valid, Pack x, Pack y, Pack z) {
  const Params<Scalar>& p = *context.params;
  Opening<Pack> result = opening(context, SQUALL_BELL, true, valid, x, y, z);
  if (is_near_container(context, valid, x, y, z))
    result.open =
        close_container_cores(&p, x, y, z, result.open, &result.gradient_x, &result.gradient_y, &result.gradient_z);
  for (int b = 0; b < context.substep->box_count; ++b) {
    const Box<Scalar>& box = context.boxes[b];
    if (!is_near_box(context, valid, box.solid_min, box.solid_max, x, y, z)) continue;
    result.open =
        close_box_core(&p, &box, x, y, z, result.open, &result.gradient_x, &result.gradient_y, &result.gradient_z);
  }
  return result;
}

/// What a block sums up over its neighbours before anything is solved.
template <class Pack>
struct PreparedSums {
  Pack kernel{0.0f};
  Pack squares{0.0f};  ///< of slopes
  Vector<Pack> apart;  ///< of weight x_ij
  Pack approaching{0.0f};
};

/// Weights of a list's pairs, from which it takes what is near no lane of the block, and sums of what comes with them.
template <class Pack>
SQUALL_NOINLINE int find_weights(const PassContext<Scalar>& context, const Pack* position, int* list, Scalar* weights,
                                 int count, PreparedSums<Pack>& sums) {
  const Params<Scalar>& p = *context.params;
  const Pack inverse_support_squared(p.inverse_support_squared), reach2(p.list_squared);
  const Record<Scalar>* records = context.sorted;
  const Pack x = position[0], y = position[1], z = position[2];
  Pack kernel[2] = {Pack(0.0f), Pack(0.0f)};  // by the parity of the sorted index
  Pack squares(0.0f);
  std::ptrdiff_t kept = 0;
  for (int k = 0; k < count; ++k) {
    const int j = list[k];
    const Record<Scalar>& b = records[j];
    const Pack r2 = squared_length(x - Pack(b.x), y - Pack(b.y), z - Pack(b.z));
    const Pack left = bell_left(r2, inverse_support_squared);
    const Pack weight = bell_weight(left);
    weight.store(weights + kept * Pack::k_lanes);
    kernel[j & 1] = kernel[j & 1] + bell_value(left);
    squares = plus_squared_slope(squares, weight, r2);
    list[kept] = j;
    kept += any(r2 < reach2) ? 1 : 0;
  }
  sums.kernel = kernel[0] + kernel[1];
  sums.squares = squares;
  return static_cast<int>(kept);
}

/// Sums over a list with its weights: of weight x_ij, and approaching_sum.
template <class Pack>
SQUALL_NOINLINE void sum_slopes(const Record<Scalar>* records, const Lanes<Pack>& a, const int* list,
                                const Scalar* weights, int count, PreparedSums<Pack>& sums) {
  const Pack x = a.x(), y = a.y(), z = a.z();
  Vector<Pack> apart;
  Pack approaching(0.0f);
  for_each_pair<Pack, Weights::near>(records, list, weights, count, [&](const Record<Scalar>& b, Pack weight) {
    const Pack dx = x - Pack(b.x), dy = y - Pack(b.y), dz = z - Pack(b.z);
    apart.add_scaled(weight, dx, dy, dz);
    approaching = fma(weight, dot_product(dx, dy, dz, Pack(b.vx), Pack(b.vy), Pack(b.vz)), approaching);
  });
  sums.apart = apart;
  sums.approaching = approaching;
}

/// Density, response to pressure, walls. Returns the density.
template <class Pack>
Pack note_prepared(const PassContext<Scalar>& context, const Block& block, const Pack* position,
                   const PreparedSums<Pack>& sums) {
  const Params<Scalar>& p = *context.params;
  const SolveArrays<Scalar>& arrays = context.solve;
  const Opening<Pack> walls =
      opening_with_cores(context, first_lanes(block.count()), position[0], position[1], position[2]);
  const Pack sum = sums.kernel;
  const Pack wall_share = Pack(1.0f) - walls.open;
  const Pack density = relative_density(sum, Pack(p.density_scale), wall_share);
  const Pack scale(p.force_scale);
  const Pack descent_x = fma(scale, sums.apart.x, walls.gradient_x);
  const Pack descent_y = fma(scale, sums.apart.y, walls.gradient_y);
  const Pack descent_z = fma(scale, sums.apart.z, walls.gradient_z);
  const Pack response = pressure_response(descent_x, descent_y, descent_z, sums.squares, scale);
  store_lanes(context.density, block, density);
  store_lanes(arrays.descent_x, block, descent_x);
  store_lanes(arrays.descent_y, block, descent_y);
  store_lanes(arrays.descent_z, block, descent_z);
  store_lanes(arrays.response, block, response);
  store_lanes(arrays.inverse_response, block, inverse_response(response, Pack(p.response_guard)));
  if (context.terms.drag)
    store_lanes(context.isolation, block,
                isolation(sum, Pack(p.self_value), Pack(p.density_scale), wall_share, Pack(p.steepness)));
  return density;
}

/// Where the solves of a block begin: the divergence solve from no impulse, the density solve from that of the last
/// pressure, which neighbours will want to know.
template <class Pack>
void note_start(const PassContext<Scalar>& context, const Block& block, const Lanes<Pack>& lanes, Pack density) {
  const Params<Scalar>& p = *context.params;
  const Substep<Scalar>& substep = *context.substep;
  const SolveArrays<Scalar>& arrays = context.solve;
  store_lanes(arrays.room, block, divergence_room(density, Pack(p.free_density)));
  store_lanes(arrays.impulse, block, Pack(0.0f));
  store_lanes(arrays.projected, block, Pack(0.0f));
  store_lanes(arrays.start_vx, block, lanes.vx());
  store_lanes(arrays.start_vy, block, lanes.vy());
  store_lanes(arrays.start_vz, block, lanes.vz());
  const Pack largest(p.largest_warm_impulse / substep.dt);
  alignas(64) Scalar warm[Pack::k_lanes];
  warm_impulse(lanes.pressure_term(), Pack(substep.warm_kick), largest).store(warm);
  for (int lane = 0; lane < block.count(); ++lane) context.sorted[block.begin + lane].volume_term = warm[lane];
}

template <class Pack>
void prepare_block(const PassContext<Scalar>& context, const Block& block, NeighbourList<Scalar>& neighbours,
                   SolveSums& totals) {
  Range ranges[9];
  int total = 0;
  const int range_count = candidate_ranges(context, block, ranges, total);
  if (!neighbours.reserve(static_cast<std::size_t>(total + Pack::k_lanes) + 3)) return;
  int* list = neighbours.data + neighbours.used + 1;
  const Pack position[3] = {Pack::load(context.x + block.begin), Pack::load(context.y + block.begin),
                            Pack::load(context.z + block.begin)};
  int count = find_neighbours(context, ranges, range_count, Bounds<Pack>(block, position), list);
  if (!neighbours.reserve_weights(static_cast<std::size_t>(count) * Pack::k_lanes)) return;
  Scalar* weights = neighbours.weights.data + neighbours.weights.used;

  const Lanes<Pack> lanes = own_lanes<Pack>(context.sorted, block);
  PreparedSums<Pack> sums;
  count = find_weights(context, position, list, weights, count, sums);
  list[-1] = count;
  list[count] = list[count + 1] = 0;  // for_each_pair looks up two more
  neighbours.used += static_cast<std::size_t>(count) + 1;
  neighbours.weights.used += static_cast<std::size_t>(count) * Pack::k_lanes;
  sum_slopes(context.sorted, lanes, list, weights, count, sums);

  const Pack density = note_prepared(context, block, position, sums);
  note_start(context, block, lanes, density);
  totals.excess += sum_of_terms(density - Pack(1.0f), first_lanes(block.count()));
  totals.error += iterate_block(context, block, lanes, sums.approaching, 0.0f);
}

}  // namespace

}  // namespace squall::openmp
