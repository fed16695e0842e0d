#pragma once

#include <cstddef>

namespace squall::openmp {

/// A thread's neighbour lists, block after block in the order the blocks are visited: a count, then sorted indices.
/// Grows as needed; no limit on how many neighbours a particle has.
struct NeighbourList {
  int* data = nullptr;
  std::size_t used = 0;
  std::size_t capacity = 0;
  bool out_of_memory = false;

  NeighbourList() = default;
  NeighbourList(NeighbourList&& other) noexcept;
  NeighbourList(const NeighbourList&) = delete;
  NeighbourList& operator=(const NeighbourList&) = delete;
  ~NeighbourList();

  /// Room for `more` entries behind `used`; false, with out_of_memory set, if there is none to be had.
  bool reserve(std::size_t more) { return used + more <= capacity || grow(more); }

 private:
  bool grow(std::size_t more);
};

}  // namespace squall::openmp
