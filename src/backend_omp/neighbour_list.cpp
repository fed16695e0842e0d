#include "backend_omp/neighbour_list.h"

#include <cstdlib>
#include <utility>

namespace squall::openmp {

NeighbourList::NeighbourList(NeighbourList&& other) noexcept
    : data(std::exchange(other.data, nullptr)),
      used(std::exchange(other.used, 0)),
      capacity(std::exchange(other.capacity, 0)),
      out_of_memory(other.out_of_memory) {}

NeighbourList::~NeighbourList() { std::free(data); }

bool NeighbourList::grow(std::size_t more) {
  const std::size_t wanted = (used + more) + (used + more) / 2;
  void* larger = std::realloc(data, wanted * sizeof(int));
  if (larger == nullptr) {
    out_of_memory = true;
    return false;
  }
  data = static_cast<int*>(larger);
  capacity = wanted;
  return true;
}

}  // namespace squall::openmp
