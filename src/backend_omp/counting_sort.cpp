#include "backend_omp/counting_sort.h"

#include <algorithm>

#include "grid.h"

namespace squall::openmp {

namespace {

int key_of(const Params<float>& p, std::span<const HeldGroup> held, const Record& record, std::uint32_t id) {
  if (is_lost(record.x)) return lost_cell(&p);
  for (const HeldGroup& group : held)
    if (id >= group.first_id && id < group.end_id) return held_cell(&p);
  return cell_of(&p, record.x, record.y, record.z);
}

int share_begin(int total, int thread, int threads) { return static_cast<int>(std::int64_t{total} * thread / threads); }

}  // namespace

CountingSort::CountingSort(int cell_count, int threads)
    : keys_(cell_count + 2),
      counts_(static_cast<std::size_t>(threads)),
      sums_(static_cast<std::size_t>(threads)),
      cell_start_(static_cast<std::size_t>(cell_count) + 3, 0) {
  for (auto& counts : counts_) counts.assign(static_cast<std::size_t>(keys_), 0);
}

void CountingSort::count_cells(int thread, Chunk chunk, const Params<float>& p, std::span<const HeldGroup> held,
                               const Record* from, const std::uint32_t* ids, int* cells) {
  std::vector<int>& counts = counts_[static_cast<std::size_t>(thread)];
  std::fill(counts.begin(), counts.end(), 0);
  for (int i = chunk.begin; i < chunk.end; ++i) {
    cells[i] = key_of(p, held, from[i], ids[i]);
    ++counts[static_cast<std::size_t>(cells[i])];
  }
}

void CountingSort::sum_cells(int thread, int threads) {
  int sum = 0;
  const int end = share_begin(keys_, thread + 1, threads);
  for (int t = 0; t < threads; ++t) {
    const auto& counts = counts_[static_cast<std::size_t>(t)];
    for (int key = share_begin(keys_, thread, threads); key < end; ++key) sum += counts[static_cast<std::size_t>(key)];
  }
  sums_[static_cast<std::size_t>(thread)] = sum;
}

void CountingSort::place_cells(int thread, int threads, int count) {
  int next = 0;
  for (int before = 0; before < thread; ++before) next += sums_[static_cast<std::size_t>(before)];
  const int end = share_begin(keys_, thread + 1, threads);
  for (int key = share_begin(keys_, thread, threads); key < end; ++key) {
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

void CountingSort::sort(TeamBarrier& barrier, int thread, int count, const Params<float>& p,
                        std::span<const HeldGroup> held, const Record* from, const std::uint32_t* from_ids, Record* to,
                        std::uint32_t* to_ids, int* cells) {
  const int threads = barrier.threads();
  const Chunk chunk{share_begin(count, thread, threads), share_begin(count, thread + 1, threads)};
  count_cells(thread, chunk, p, held, from, from_ids, cells);
  barrier.wait(thread);
  sum_cells(thread, threads);
  barrier.wait(thread);
  place_cells(thread, threads, count);
  barrier.wait(thread);
  std::vector<int>& next = counts_[static_cast<std::size_t>(thread)];
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const int place = next[static_cast<std::size_t>(cells[i])]++;
    to[place] = from[i];
    to_ids[place] = from_ids[i];
  }
  barrier.wait(thread);
}

}  // namespace squall::openmp
