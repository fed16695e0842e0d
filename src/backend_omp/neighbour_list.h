#pragma once

#include <cstddef>

#include "backend_omp/out_of_reach.h"

namespace squall::openmp {

/// A thread's values per neighbour and lane of its blocks, in the order of its NeighbourList; on cache lines.
template <class Scalar>
struct PairValues {
  Scalar* data = nullptr;
  std::size_t used = 0;
  std::size_t capacity = 0;

  PairValues() = default;
  PairValues(PairValues&& other) noexcept;
  PairValues(const PairValues&) = delete;
  PairValues& operator=(const PairValues&) = delete;
  ~PairValues();

  /// Room for `more` values behind `used`; false if there is none to be had.
  bool reserve(std::size_t more) {
    if (used + more > capacity && !grow(more)) return false;
    put_out_of_reach(data, used + more, capacity);
    return true;
  }

 private:
  bool grow(std::size_t more);
};

/// A thread's neighbour lists, block after block in the order the blocks are visited: a count, then sorted indices.
/// Grows as needed; no limit on how many neighbours a particle has.
template <class Scalar>
struct NeighbourList {
  int* data = nullptr;
  std::size_t used = 0;
  std::size_t capacity = 0;
  bool out_of_memory = false;
  PairValues<Scalar> weights;  ///< dfsph: bell_weight of each neighbour and lane

  NeighbourList() = default;
  NeighbourList(NeighbourList&& other) noexcept;
  NeighbourList(const NeighbourList&) = delete;
  NeighbourList& operator=(const NeighbourList&) = delete;
  ~NeighbourList();

  /// Room for `more` entries behind `used`; false, with out_of_memory set, if there is none to be had.
  bool reserve(std::size_t more) {
    if (used + more > capacity && !grow(more)) return false;
    put_out_of_reach(data, used + more, capacity);
    return true;
  }
  /// The same for weights.
  bool reserve_weights(std::size_t more) {
    out_of_memory = out_of_memory || !weights.reserve(more);
    return !out_of_memory;
  }

 private:
  bool grow(std::size_t more);
};

}  // namespace squall::openmp
