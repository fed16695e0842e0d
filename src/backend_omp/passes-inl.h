#pragma once

// Included once per instruction set, after its Pack: the passes over blocks of particles, a particle per SIMD lane.

#include "backend_omp/block-inl.h"
#include "backend_omp/integrate-inl.h"

namespace squall::openmp {

namespace {

/// Appends to `list` every candidate that lies within H (1 + 5e-6) of any particle of the block: a superset of the
/// neighbours, in canonical order. What is beyond H adds exactly zero to every sum. Returns how many.
template <class Pack>
int find_neighbours(const PassContext& context, const Range* ranges, int range_count, Mask valid, Pack x, Pack y,
                    Pack z, int* list) {
  const Pack reach2(context.params->list_squared);
  int count = 0;
  for (int k = 0; k < range_count; ++k) {
    for (int j = ranges[k].begin; j < ranges[k].end; ++j) {
      const Record& candidate = context.sorted[j];
      const Pack dx = x - Pack(candidate.x), dy = y - Pack(candidate.y), dz = z - Pack(candidate.z);
      list[count] = j;
      count += any(valid & (squared_length(dx, dy, dz) < reach2)) ? 1 : 0;
    }
  }
  return count;
}

/// What neighbour j adds to the density's kernel sum.
template <class Pack, Pressure pressure>
Pack density_term(const Params<float>& p, const Record& b, Pack x, Pack y, Pack z) {
  const Pack dx = x - Pack(b.x), dy = y - Pack(b.y), dz = z - Pack(b.z);
  if constexpr (pressure == Pressure::wcsph) {
    const Pack r = sqrt(squared_length(dx, dy, dz));
    return cubic_value(remaining_support(r, Pack(p.inverse_support)),
                       remaining_support(r, Pack(p.inverse_half_support)));
  } else {
    return poly6_value(squared_support_left(dx, dy, dz, Pack(p.support_squared)));
  }
}

template <class Pack, Pressure pressure>
void density_of_block(const PassContext& context, const Block& block, NeighbourList& neighbours) {
  const Params<float>& p = *context.params;
  Range ranges[9];
  int total = 0;
  const int range_count = candidate_ranges(context, block, ranges, total);
  if (!neighbours.reserve(static_cast<std::size_t>(total) + 1)) return;
  int* list = neighbours.data + neighbours.used + 1;

  const Mask valid = first_lanes(block.count());
  const Pack x = gather<Pack>(context.sorted, block.begin, &Record::x);
  const Pack y = gather<Pack>(context.sorted, block.begin, &Record::y);
  const Pack z = gather<Pack>(context.sorted, block.begin, &Record::z);
  const int count = find_neighbours(context, ranges, range_count, valid, x, y, z, list);
  list[-1] = count;
  neighbours.used += static_cast<std::size_t>(count) + 1;

  Pack sums[2] = {Pack(0.0f), Pack(0.0f)};  // by the parity of the sorted index
  for (int k = 0; k < count; ++k) {
    const int j = list[k];
    sums[j & 1] = sums[j & 1] + density_term<Pack, pressure>(p, context.sorted[j], x, y, z);
  }
  const Pack sum = sums[0] + sums[1];

  constexpr int kernel_shape = pressure == Pressure::wcsph ? SQUALL_CUBIC : SQUALL_POLY6;
  const Pack wall_share = Pack(1.0f) - opening(context, kernel_shape, true, valid, x, y, z).open;
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
  alignas(64) float pressures[Pack::k_lanes], volumes[Pack::k_lanes];
  pressure_term.store(pressures);
  volume_term.store(volumes);
  for (int lane = 0; lane < block.count(); ++lane) {
    context.sorted[block.begin + lane].pressure_term = pressures[lane];
    context.sorted[block.begin + lane].volume_term = volumes[lane];
  }
}

/// The block's own lanes in the force pass.
template <class Pack>
struct Lanes {
  Pack x, y, z, vx, vy, vz;
  Lanes(const Record* records, int begin)
      : x(gather<Pack>(records, begin, &Record::x)),
        y(gather<Pack>(records, begin, &Record::y)),
        z(gather<Pack>(records, begin, &Record::z)),
        vx(gather<Pack>(records, begin, &Record::vx)),
        vy(gather<Pack>(records, begin, &Record::vy)),
        vz(gather<Pack>(records, begin, &Record::vz)) {}
};

template <class Pack>
struct Vector {
  Pack x{0.0f}, y{0.0f}, z{0.0f};
  void add_scaled(Pack s, Pack dx, Pack dy, Pack dz) {
    x = fma(s, dx, x);
    y = fma(s, dy, y);
    z = fma(s, dz, z);
  }
};

template <class Pack, bool viscous>
Vector<Pack> wcsph_acceleration(const PassContext& context, const Block& block, const Lanes<Pack>& a, const int* list,
                                int count) {
  const Params<float>& p = *context.params;
  const Pack pressure_term = gather<Pack>(context.sorted, block.begin, &Record::pressure_term);
  const Pack volume_term = gather<Pack>(context.sorted, block.begin, &Record::volume_term);
  Vector<Pack> sum;
  for (int k = 0; k < count; ++k) {
    const Record& b = context.sorted[list[k]];
    const Pack dx = a.x - Pack(b.x), dy = a.y - Pack(b.y), dz = a.z - Pack(b.z);
    const Pack r2 = squared_length(dx, dy, dz);
    const Pack r = sqrt(r2);
    const Pack u = remaining_support(r, Pack(p.inverse_support));
    const Pack w = remaining_support(r, Pack(p.inverse_half_support));
    const Pack receding = dot_product(dx, dy, dz, a.vx - Pack(b.vx), a.vy - Pack(b.vy), a.vz - Pack(b.vz));
    Pack shear = Pack(p.artificial_scale) * max0(-receding);
    if constexpr (viscous) shear = nfma(Pack(p.viscosity_scale), receding, shear);
    sum.add_scaled(wcsph_pair(r, r2, cubic_slope(u, w), pressure_term + Pack(b.pressure_term),
                              volume_term + Pack(b.volume_term), shear, Pack(p.softening), Pack(p.tiny)),
                   dx, dy, dz);
  }
  const Opening<Pack> walls = opening(context, SQUALL_CUBIC, false, first_lanes(block.count()), a.x, a.y, a.z);
  const Pack scale(p.force_scale);
  return {fma(scale, sum.x, pressure_term * walls.gradient_x), fma(scale, sum.y, pressure_term * walls.gradient_y),
          fma(scale, sum.z, pressure_term * walls.gradient_z)};
}

template <class Pack, bool viscous>
Vector<Pack> mueller_acceleration(const PassContext& context, const Block& block, const Lanes<Pack>& a, const int* list,
                                  int count) {
  const Params<float>& p = *context.params;
  const Pack pressure = Pack::load(context.pressure + block.begin);
  const Pack density = Pack::load(context.density + block.begin);
  Vector<Pack> push, drag;
  for (int k = 0; k < count; ++k) {
    const Record& b = context.sorted[list[k]];
    const Pack dx = a.x - Pack(b.x), dy = a.y - Pack(b.y), dz = a.z - Pack(b.z);
    const Pack r = sqrt(squared_length(dx, dy, dz));
    const Pack u = remaining_support(r, Pack(p.inverse_support));
    push.add_scaled(mueller_pair(r, u, pressure, Pack(b.volume_term), Pack(b.pressure_term), Pack(p.tiny)), dx, dy, dz);
    if constexpr (viscous)
      drag.add_scaled(viscosity_laplacian(u) * Pack(b.volume_term), Pack(b.vx) - a.vx, Pack(b.vy) - a.vy,
                      Pack(b.vz) - a.vz);
  }
  const Opening<Pack> walls = opening(context, SQUALL_SPIKY, false, first_lanes(block.count()), a.x, a.y, a.z);
  const auto total = [&](Pack pushed, Pack gradient, Pack dragged) {
    Pack force = fma(Pack(p.force_scale), pushed, pressure * gradient);
    if constexpr (viscous) force = fma(Pack(p.viscosity_scale), dragged, force);
    return force / density;
  };
  return {total(push.x, walls.gradient_x, drag.x), total(push.y, walls.gradient_y, drag.y),
          total(push.z, walls.gradient_z, drag.z)};
}

template <class Pack>
struct BlockPasses {
  template <Pressure pressure>
  static void density_rows(const PassContext& context, int first_row, int end_row, NeighbourList& list) {
    list.used = 0;
    for_each_block<Pack>(context, first_row, end_row,
                         [&](const Block& block) { density_of_block<Pack, pressure>(context, block, list); });
  }

  template <Pressure pressure, bool viscous>
  static void force_rows(const PassContext& context, int first_row, int end_row, const NeighbourList& list,
                         PassResult& result) {
    const int* neighbours = list.data;
    for_each_block<Pack>(context, first_row, end_row, [&](const Block& block) {
      const int count = *neighbours++;
      const Lanes<Pack> lanes(context.sorted, block.begin);
      Vector<Pack> a;
      if constexpr (pressure == Pressure::wcsph)
        a = wcsph_acceleration<Pack, viscous>(context, block, lanes, neighbours, count);
      else
        a = mueller_acceleration<Pack, viscous>(context, block, lanes, neighbours, count);
      integrate_block<Pack>(context, block, lanes.x, lanes.y, lanes.z, lanes.vx, lanes.vy, lanes.vz, a.x, a.y, a.z,
                            result);
      neighbours += count;
    });
  }

  template <Pressure pressure>
  static void statistics_rows(const PassContext& context, int first_row, int end_row, const NeighbourList& list,
                              PassResult& result) {
    const int* neighbours = list.data;
    for_each_block<Pack>(context, first_row, end_row, [&](const Block& block) {
      const int count = *neighbours++;
      for (int i = block.begin; i < block.end; ++i) {
        const Record& a = context.sorted[i];
        std::int64_t within = -1;  // self is on the list
        for (int k = 0; k < count; ++k)
          within += is_neighbour<pressure>(*context.params, a, context.sorted[neighbours[k]]);
        result.neighbours += within;
        const float error = max0(context.density[i] - 1.0f);
        result.density_error_sum += static_cast<double>(error);
        if (error > result.density_error_max) result.density_error_max = error;
      }
      neighbours += count;
    });
  }

  template <Pressure pressure>
  static int is_neighbour(const Params<float>& p, const Record& a, const Record& b) {
    const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    if constexpr (pressure == Pressure::wcsph)
      return remaining_support(squall::sqrt(squared_length(dx, dy, dz)), p.inverse_support) > 0.0f ? 1 : 0;
    else
      return squared_support_left(dx, dy, dz, p.support_squared) > 0.0f ? 1 : 0;
  }

  static void density(const PassContext& context, int first_row, int end_row, NeighbourList& list) {
    if (context.terms.pressure == Pressure::wcsph)
      density_rows<Pressure::wcsph>(context, first_row, end_row, list);
    else
      density_rows<Pressure::mueller>(context, first_row, end_row, list);
  }

  static void forces(const PassContext& context, int first_row, int end_row, const NeighbourList& list,
                     PassResult& result) {
    const bool viscous = context.terms.viscosity;
    if (context.terms.pressure == Pressure::wcsph)
      (viscous ? force_rows<Pressure::wcsph, true> : force_rows<Pressure::wcsph, false>)(context, first_row, end_row,
                                                                                         list, result);
    else
      (viscous ? force_rows<Pressure::mueller, true> : force_rows<Pressure::mueller, false>)(context, first_row,
                                                                                             end_row, list, result);
  }

  static void statistics(const PassContext& context, int first_row, int end_row, const NeighbourList& list,
                         PassResult& result) {
    if (context.terms.pressure == Pressure::wcsph)
      statistics_rows<Pressure::wcsph>(context, first_row, end_row, list, result);
    else
      statistics_rows<Pressure::mueller>(context, first_row, end_row, list, result);
  }

  static const Passes& table() {
    static constexpr Passes k_table{density, forces, statistics};
    return k_table;
  }
};

}  // namespace

}  // namespace squall::openmp
