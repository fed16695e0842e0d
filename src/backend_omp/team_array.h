#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>

#include "backend_omp/out_of_reach.h"

namespace squall::openmp {

/// An array on cache lines that a team shares. Memory belongs to the processor that touches it first: a larger array is
/// filled by as many threads as work on it, each its share.
template <class T>
class TeamArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  std::size_t size() const { return size_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

  /// Keeps what there is; new elements are `value`.
  void resize(std::size_t size, const T& value, int threads) {
    if (size > capacity_) grow(size, value, threads);
    put_out_of_reach(data_.get(), size, capacity_);
    if (size > size_) std::fill(data_.get() + size_, data_.get() + size, value);
    size_ = size;
  }

 private:
  struct Free {
    void operator()(T* memory) const { ::operator delete[](memory, k_line); }
  };
  static constexpr std::align_val_t k_line{64};

  void grow(std::size_t size, const T& value, int threads) {
    const std::size_t capacity = std::max(size, capacity_ + capacity_ / 2);
    std::unique_ptr<T[], Free> larger(static_cast<T*>(::operator new[](capacity * sizeof(T), k_line)));
    T* to = larger.get();
    const T* from = data_.get();
    const auto old = static_cast<std::int64_t>(size_), all = static_cast<std::int64_t>(capacity);
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::int64_t i = 0; i < all; ++i) to[i] = i < old ? from[i] : value;
    data_ = std::move(larger);
    capacity_ = capacity;
  }

  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace squall::openmp
