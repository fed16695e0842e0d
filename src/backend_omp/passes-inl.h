#pragma once

// Included once per instruction set and precision, after its Pack: the passes over blocks of particles, a particle per
// SIMD lane.

#include "backend_omp/density-inl.h"
#include "backend_omp/forces-inl.h"
#include "backend_omp/integrate-inl.h"
#include "backend_omp/predict-inl.h"
#include "backend_omp/prepare-inl.h"

namespace squall::openmp {

namespace {

template <class Pack>
struct BlockPasses {
  template <Pressure pressure>
  static void density_rows(const PassContext<Scalar>& context, int first_row, int end_row,
                           NeighbourList<Scalar>& list) {
    list.used = 0;
    for_each_block<Pack>(context, first_row, end_row,
                         [&](const Block& block) { density_of_block<Pack, pressure>(context, block, list); });
  }

  template <Pressure pressure, bool viscous>
  static void force_rows(const PassContext<Scalar>& context, int first_row, int end_row,
                         const NeighbourList<Scalar>& list, PassResult<Scalar>& result, int* key_counts) {
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
  static void statistics_rows(const PassContext<Scalar>& context, int first_row, int end_row,
                              const NeighbourList<Scalar>& list, PassResult<Scalar>& result) {
    const int* neighbours = list.data;
    for_each_block<Pack>(context, first_row, end_row, [&](const Block& block) {
      const int count = *neighbours++;
      alignas(64) Scalar within[Pack::k_lanes];
      count_neighbours<pressure>(context, own_lanes<Pack>(context.sorted, block), neighbours, count).store(within);
      for (int i = block.begin; i < block.end; ++i) {
        context.neighbours[i] = static_cast<int>(within[i - block.begin]) - 1;  // self is on the list
        result.neighbours += context.neighbours[i];
        const Scalar error = max0(context.density[i] - 1.0f);
        result.density_error_sum += static_cast<double>(error);
        if (error > result.density_error_max) result.density_error_max = error;
      }
      neighbours += count;
    });
  }

  template <Pressure pressure>
  static Pack count_neighbours(const PassContext<Scalar>& context, const Lanes<Pack>& a, const int* list, int count) {
    const Pack x = a.x(), y = a.y(), z = a.z();
    Pack within(0.0f);
    for (int k = 0; k < count; ++k) {
      const Record<Scalar>& b = context.sorted[list[k]];
      const Pack left = support_left<pressure>(*context.params, x - Pack(b.x), y - Pack(b.y), z - Pack(b.z));
      within = within + select(Pack(0.0f) < left, Pack(1.0f), Pack(0.0f));
    }
    return within;
  }

  /// Positive within H and 0 beyond, as the density kernel has it.
  template <Pressure pressure>
  static Pack support_left(const Params<Scalar>& p, Pack dx, Pack dy, Pack dz) {
    if constexpr (pressure == Pressure::wcsph)
      return remaining_support(sqrt(squared_length(dx, dy, dz)), Pack(p.inverse_support));
    else if constexpr (pressure == Pressure::dfsph)
      return bell_left(squared_length(dx, dy, dz), Pack(p.inverse_support_squared));
    else
      return squared_support_left(dx, dy, dz, Pack(p.support_squared));
  }

  static void density(const PassContext<Scalar>& context, int first_row, int end_row, NeighbourList<Scalar>& list) {
    if (context.terms.pressure == Pressure::wcsph)
      density_rows<Pressure::wcsph>(context, first_row, end_row, list);
    else
      density_rows<Pressure::mueller>(context, first_row, end_row, list);
  }

  static void forces(const PassContext<Scalar>& context, int first_row, int end_row, const NeighbourList<Scalar>& list,
                     PassResult<Scalar>& result, int* key_counts) {
    const bool viscous = context.terms.viscosity;
    const auto rows = context.terms.pressure == Pressure::wcsph
                          ? (viscous ? force_rows<Pressure::wcsph, true> : force_rows<Pressure::wcsph, false>)
                          : (viscous ? force_rows<Pressure::mueller, true> : force_rows<Pressure::mueller, false>);
    rows(context, first_row, end_row, list, result, key_counts);
  }

  static void statistics(const PassContext<Scalar>& context, int first_row, int end_row,
                         const NeighbourList<Scalar>& list, PassResult<Scalar>& result) {
    const auto rows = context.terms.pressure == Pressure::wcsph     ? statistics_rows<Pressure::wcsph>
                      : context.terms.pressure == Pressure::mueller ? statistics_rows<Pressure::mueller>
                                                                    : statistics_rows<Pressure::dfsph>;
    rows(context, first_row, end_row, list, result);
  }

  static void prepare(const PassContext<Scalar>& context, int first_row, int end_row, NeighbourList<Scalar>& list,
                      SolveSums& sums) {
    list.used = list.weights.used = 0;
    for_each_block<Pack>(context, first_row, end_row,
                         [&](const Block& block) { prepare_block<Pack>(context, block, list, sums); });
  }

  /// Calls visit(block, list, weights, count) for every block and its neighbours.
  template <class Visit>
  static void for_each_list(const PassContext<Scalar>& context, int first_row, int end_row,
                            const NeighbourList<Scalar>& list, Visit visit) {
    const int* neighbours = list.data;
    const Scalar* weights = list.weights.data;
    for_each_block<Pack>(context, first_row, end_row, [&](const Block& block) {
      const int count = *neighbours++;
      visit(block, neighbours, weights, count);
      neighbours += count;
      weights += static_cast<std::ptrdiff_t>(count) * Pack::k_lanes;
    });
  }

  static std::int64_t rate(const PassContext<Scalar>& context, int first_row, int end_row,
                           const NeighbourList<Scalar>& list, Scalar momentum) {
    std::int64_t sum = 0;
    for_each_list(context, first_row, end_row, list, [&](const Block& block, const int* j, const Scalar* w, int count) {
      const Lanes<Pack> lanes = own_lanes<Pack>(context.sorted, block);
      sum += iterate_block<Pack>(context, block, lanes, approaching_sum<Pack>(context.sorted, lanes, j, w, count),
                                 momentum);
    });
    return sum;
  }

  static void push(const PassContext<Scalar>& context, int first_row, int end_row, const NeighbourList<Scalar>& list) {
    for_each_list(context, first_row, end_row, list, [&](const Block& block, const int* j, const Scalar* w, int count) {
      push_block<Pack>(context, block, j, w, count);
    });
  }

  template <bool viscous, bool smoothing>
  static void predict_rows(const PassContext<Scalar>& context, int first_row, int end_row,
                           const NeighbourList<Scalar>& list, Scalar correction) {
    for_each_list(context, first_row, end_row, list, [&](const Block& block, const int* j, const Scalar* w, int count) {
      predict_block<Pack, viscous, smoothing>(context, block, j, w, count, correction);
    });
  }

  static void predict(const PassContext<Scalar>& context, int first_row, int end_row, const NeighbourList<Scalar>& list,
                      Scalar correction) {
    const PassTerms& terms = context.terms;
    const auto rows = terms.smoothing ? (terms.viscosity ? predict_rows<true, true> : predict_rows<false, true>)
                                      : (terms.viscosity ? predict_rows<true, false> : predict_rows<false, false>);
    rows(context, first_row, end_row, list, correction);
  }

  static void drift(const PassContext<Scalar>& context, int first_row, int end_row, PassResult<Scalar>& result,
                    int* key_counts) {
    Maxima<Pack> maxima;
    for_each_block<Pack>(context, first_row, end_row,
                         [&](const Block& block) { drift_block<Pack>(context, block, result, maxima, key_counts); });
    maxima.report(result);
  }

  static const Passes<Scalar>& table() {
    static constexpr Passes<Scalar> k_table{Pack::k_lanes, density, forces,  statistics, prepare,
                                            rate,          push,    predict, drift};
    return k_table;
  }
};

}  // namespace

}  // namespace squall::openmp
