#include "backend_omp/counting_sort.h"

#include <algorithm>

#include "grid.h"

namespace squall::openmp {

namespace {

template <class Scalar>
int key_of(const Params<Scalar>& p, std::span<const HeldGroup> held, const Record<Scalar>& record, std::uint32_t id) {
  if (is_lost(record.x)) return lost_cell(&p);
  for (const HeldGroup& group : held)
    if (id >= group.first_id && id < group.end_id) return held_cell(&p);
  return cell_of(&p, record.x, record.y, record.z);
}

}  // namespace

template <class Scalar>
CountingSort<Scalar>::CountingSort(int cell_count, int threads)
    : keys_(cell_count + 2),
      counts_(static_cast<std::size_t>(threads)),
      sums_(static_cast<std::size_t>(threads)),
      cell_start_(static_cast<std::size_t>(cell_count) + 3, 0) {}

template <class Scalar>
int* CountingSort<Scalar>::clear_counts(int thread) {
  std::vector<int>& counts = counts_[static_cast<std::size_t>(thread)];
  counts.assign(static_cast<std::size_t>(keys_), 0);  // the first time by the thread whose it is
  return counts.data();
}

template <class Scalar>
void CountingSort<Scalar>::count(int thread, Range range, const Params<Scalar>& p, std::span<const HeldGroup> held,
                                 const UnsortedParticles<Scalar>& from) {
  std::vector<int>& counts = counts_[static_cast<std::size_t>(thread)];
  for (int i = range.begin; i < range.end; ++i) {
    from.keys[i] = key_of(p, held, from.records[i], from.ids[i]);
    ++counts[static_cast<std::size_t>(from.keys[i])];
  }
}

template <class Scalar>
void CountingSort<Scalar>::sum_keys(int thread, int threads) {
  int sum = 0;
  const Range share = share_of(keys_, thread, threads);
  for (int t = 0; t < threads; ++t) {
    const auto& counts = counts_[static_cast<std::size_t>(t)];
    for (int key = share.begin; key < share.end; ++key) sum += counts[static_cast<std::size_t>(key)];
  }
  sums_[static_cast<std::size_t>(thread)] = sum;
}

template <class Scalar>
void CountingSort<Scalar>::place_keys(int thread, int threads, int count) {
  int next = 0;
  for (int before = 0; before < thread; ++before) next += sums_[static_cast<std::size_t>(before)];
  const Range share = share_of(keys_, thread, threads);
  for (int key = share.begin; key < share.end; ++key) {
    cell_start_[static_cast<std::size_t>(key)] = next;
    for (int t = 0; t < threads; ++t) {
      auto& counts = counts_[static_cast<std::size_t>(t)];
      const int here = counts[static_cast<std::size_t>(key)];
      counts[static_cast<std::size_t>(key)] = next;
      next += here;
    }
  }
  if (thread == threads - 1) cell_start_[static_cast<std::size_t>(keys_)] = count;
}

template <class Scalar>
void CountingSort<Scalar>::sort(TeamBarrier& barrier, int thread, Range chunk, int count,
                                const UnsortedParticles<Scalar>& from, const SortedParticles<Scalar>& to) {
  const int threads = barrier.threads();
  sum_keys(thread, threads);
  barrier.wait(thread);
  place_keys(thread, threads, count);
  barrier.wait(thread);
  int* next = counts_[static_cast<std::size_t>(thread)].data();
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const int place = next[from.keys[i]]++;
    const Record<Scalar> record = from.records[i];
    to.records[place] = record;
    to.ids[place] = from.ids[i];
    to.x[place] = record.x;
    to.y[place] = record.y;
    to.z[place] = record.z;
  }
  barrier.wait(thread);
}

template class CountingSort<float>;
template class CountingSort<double>;

}  // namespace squall::openmp
