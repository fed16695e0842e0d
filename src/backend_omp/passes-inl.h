#pragma once

// Included once per instruction set, after its Pack: the passes over blocks of particles, a particle per SIMD lane.

#include "backend_omp/density-inl.h"
#include "backend_omp/forces-inl.h"
#include "backend_omp/integrate-inl.h"

namespace squall::openmp {

namespace {

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
                         PassResult& result, int* key_counts) {
    Maxima<Pack> maxima;
    const int* neighbours = list.data;
    for_each_block<Pack>(context, first_row, end_row, [&](const Block& block) {
      const int count = *neighbours++;
      const Lanes<Pack> lanes(context.sorted, block.begin);
      Vector<Pack> a;
      if constexpr (pressure == Pressure::wcsph)
        a = wcsph_acceleration<Pack, viscous>(context, block, lanes, neighbours, count);
      else
        a = mueller_acceleration<Pack, viscous>(context, block, lanes, neighbours, count);
      integrate_block<Pack>(context, block, lanes, a, result, maxima, key_counts);
      neighbours += count;
    });
    maxima.report(result);
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
                     PassResult& result, int* key_counts) {
    const bool viscous = context.terms.viscosity;
    const auto rows = context.terms.pressure == Pressure::wcsph
                          ? (viscous ? force_rows<Pressure::wcsph, true> : force_rows<Pressure::wcsph, false>)
                          : (viscous ? force_rows<Pressure::mueller, true> : force_rows<Pressure::mueller, false>);
    rows(context, first_row, end_row, list, result, key_counts);
  }

  static void statistics(const PassContext& context, int first_row, int end_row, const NeighbourList& list,
                         PassResult& result) {
    if (context.terms.pressure == Pressure::wcsph)
      statistics_rows<Pressure::wcsph>(context, first_row, end_row, list, result);
    else
      statistics_rows<Pressure::mueller>(context, first_row, end_row, list, result);
  }

  static const Passes& table() {
    static constexpr Passes k_table{Pack::k_lanes, density, forces, statistics};
    return k_table;
  }
};

}  // namespace

}  // namespace squall::openmp
