#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "backend_omp/passes.h"
#include "backend_omp/team_barrier.h"

namespace squall::openmp {

/// A stable counting sort by cell, run by a team of up to `threads` threads: each takes a contiguous chunk of the
/// particles, counts its cells and scatters to where chunks before it and cells before end.
class CountingSort {
 public:
  CountingSort(int cell_count, int threads);

  /// Where each cell starts: cell_count + 3 entries (cells, held, lost, end). Valid after sort().
  const int* cell_start() const { return cell_start_.data(); }

  /// Sorts `count` records and ids from `from` to `to`. Called by every thread of the barrier's team, each with its
  /// number; waits there. Sorted on return, for every thread. `cells` has room for `count`.
  void sort(TeamBarrier& barrier, int thread, int count, const Params<float>& p, std::span<const HeldGroup> held,
            const Record* from, const std::uint32_t* from_ids, Record* to, std::uint32_t* to_ids, int* cells);

 private:
  struct Chunk {
    int begin, end;
  };
  void count_cells(int thread, Chunk chunk, const Params<float>& p, std::span<const HeldGroup> held, const Record* from,
                   const std::uint32_t* ids, int* cells);
  void sum_cells(int thread, int threads);
  void place_cells(int thread, int threads, int count);

  int keys_;                              ///< cells, held, lost
  std::vector<std::vector<int>> counts_;  ///< per thread and key: a count, then where the thread's next one goes
  std::vector<int> sums_;                 ///< per thread: particles in its share of the keys
  std::vector<int> cell_start_;
};

}  // namespace squall::openmp
