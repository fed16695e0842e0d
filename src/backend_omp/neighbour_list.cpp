#include "backend_omp/neighbour_list.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace squall::openmp {

template <class Scalar>
PairValues<Scalar>::PairValues(PairValues&& other) noexcept
    : data(std::exchange(other.data, nullptr)),
      used(std::exchange(other.used, 0)),
      capacity(std::exchange(other.capacity, 0)) {}

template <class Scalar>
PairValues<Scalar>::~PairValues() {
  std::free(data);
}

template <class Scalar>
bool PairValues<Scalar>::grow(std::size_t more) {
  constexpr std::size_t k_line = 64;
  const std::size_t wanted = (used + more) + (used + more) / 2;
  const std::size_t bytes = (wanted * sizeof(Scalar) + k_line - 1) / k_line * k_line;
  auto* larger = static_cast<Scalar*>(std::aligned_alloc(k_line, bytes));
  if (larger == nullptr) return false;
  std::copy(data, data + used, larger);
  std::free(data);
  data = larger;
  capacity = wanted;
  return true;
}

template <class Scalar>
NeighbourList<Scalar>::NeighbourList(NeighbourList&& other) noexcept
    : data(std::exchange(other.data, nullptr)),
      used(std::exchange(other.used, 0)),
      capacity(std::exchange(other.capacity, 0)),
      out_of_memory(other.out_of_memory),
      weights(std::move(other.weights)) {}

template <class Scalar>
NeighbourList<Scalar>::~NeighbourList() {
  std::free(data);
}

template <class Scalar>
bool NeighbourList<Scalar>::grow(std::size_t more) {
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

template struct PairValues<float>;
template struct PairValues<double>;
template struct NeighbourList<float>;
template struct NeighbourList<double>;

}  // namespace squall::openmp
