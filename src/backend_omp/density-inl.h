#pragma once

// Included once per instruction set and precision, after its Pack: neighbours, density, and what it says of pressure.

#include "backend_omp/neighbours-inl.h"
#include "core/smoothing_kernels.h"

namespace squall::openmp {

namespace {

/// What a neighbour adds to the density's kernel sum, and whether it is near any lane at all.
template <class Pack, Pressure pressure>
Pack density_term(const Params<Scalar>& p, Pack dx, Pack dy, Pack dz, bool& near) {
  if constexpr (pressure == Pressure::wcsph) {
    const Pack r2 = squared_length(dx, dy, dz);
    near = any(r2 < Pack(p.list_squared));
    const Pack r = sqrt(r2);
    return cubic_value(remaining_support(r, Pack(p.inverse_support)),
                       remaining_support(r, Pack(p.inverse_half_support)));
  } else {
    const Pack left = squared_support_difference(dx, dy, dz, Pack(p.support_squared));
    near = any(Pack(p.support_squared - p.list_squared) < left);
    return poly6_value(max0(left));
  }
}

/// The density's kernel sum over a list, from which it takes what is near no lane of the block.
template <class Pack, Pressure pressure>
Pack density_sum(const PassContext<Scalar>& context, const Pack* position, int* list, int& count) {
  const Pack x = position[0], y = position[1], z = position[2];
  Pack sums[2] = {Pack(0.0f), Pack(0.0f)};  // by the parity of the sorted index
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    const int j = list[k];
    const Record<Scalar>& b = context.sorted[j];
    bool near = false;
    const Pack term = density_term<Pack, pressure>(*context.params, x - Pack(b.x), y - Pack(b.y), z - Pack(b.z), near);
    list[kept] = j;
    kept += near ? 1 : 0;
    sums[j & 1] = sums[j & 1] + term;
  }
  count = kept;
  return sums[0] + sums[1];
}

template <class Pack, Pressure pressure>
void density_of_block(const PassContext<Scalar>& context, const Block& block, NeighbourList<Scalar>& neighbours) {
  const Params<Scalar>& p = *context.params;
  Range ranges[9];
  int total = 0;
  const int range_count = candidate_ranges(context, block, ranges, total);
  if (!neighbours.reserve(static_cast<std::size_t>(total + Pack::k_lanes) + 1)) return;
  int* list = neighbours.data + neighbours.used + 1;

  const Pack position[3] = {Pack::load(context.x + block.begin), Pack::load(context.y + block.begin),
                            Pack::load(context.z + block.begin)};
  const auto& [x, y, z] = position;
  int count = find_neighbours(context, ranges, range_count, Bounds<Pack>(block, position), list);
  const Pack sum = density_sum<Pack, pressure>(context, position, list, count);
  list[-1] = count;
  neighbours.used += static_cast<std::size_t>(count) + 1;

  constexpr int kernel_shape = density_kernel(pressure);
  const Pack wall_share = Pack(1.0f) - opening(context, kernel_shape, true, first_lanes(block.count()), x, y, z).open;
  const Pack density = relative_density(sum, Pack(p.density_scale), wall_share);
  Pack kinematic_pressure, pressure_term, volume_term;
  if constexpr (pressure == Pressure::wcsph) {
    kinematic_pressure = tait_pressure(density, Pack(p.stiffness));
    volume_term = Pack(1.0f) / density;
    pressure_term = kinematic_pressure / (density * density);
  } else {
    kinematic_pressure = mueller_pressure(density, Pack(p.stiffness), Pack(p.tension));
    volume_term = Pack(p.one_half) / density;
    pressure_term = kinematic_pressure * volume_term;
    store_lanes(context.pressure, block, kinematic_pressure);
  }
  store_lanes(context.density, block, density);
  if (context.terms.drag)
    store_lanes(context.isolation, block,
                isolation(sum, Pack(p.self_value), Pack(p.density_scale), wall_share, Pack(p.steepness)));
  alignas(64) Scalar pressures[Pack::k_lanes], volumes[Pack::k_lanes];
  pressure_term.store(pressures);
  volume_term.store(volumes);
  for (int lane = 0; lane < block.count(); ++lane) {
    context.sorted[block.begin + lane].pressure_term = pressures[lane];
    context.sorted[block.begin + lane].volume_term = volumes[lane];
  }
}

}  // namespace

}  // namespace squall::openmp
