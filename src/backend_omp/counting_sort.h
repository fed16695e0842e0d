#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "backend_omp/passes.h"
#include "backend_omp/team_barrier.h"

namespace squall::openmp {

/// Particles as they are before a sort, with the key (cell, held or lost) of each.
template <class Scalar>
struct UnsortedParticles {
  const Record<Scalar>* records;
  const std::uint32_t* ids;
  int* keys;
};

/// Where sorted particles go: records, ids, and the coordinates once more, each in a row.
template <class Scalar>
struct SortedParticles {
  Record<Scalar>* records;
  std::uint32_t* ids;
  Scalar* x;
  Scalar* y;
  Scalar* z;
};

/// A stable counting sort by cell, run by a team of up to `threads` threads: each takes a contiguous chunk of the
/// particles, counts its cells and scatters to where chunks before it and cells before end. Chunks follow each other in
/// the order of the threads.
template <class Scalar>
class CountingSort {
 public:
  CountingSort(int cell_count, int threads);

  /// Where each cell starts: cell_count + 3 entries (cells, held, lost, end). Valid after sort().
  const int* cell_start() const { return cell_start_.data(); }

  /// Forgets what the thread has counted. Returns its count per key, for whoever knows the keys already to fill.
  int* clear_counts(int thread);

  /// Writes the keys of a range of particles and adds them to what the thread has counted.
  void count(int thread, Range range, const Params<Scalar>& p, std::span<const HeldGroup> held,
             const UnsortedParticles<Scalar>& from);

  /// Sorts the first `count` particles. Called by every thread of the barrier's team once all of them have counted
  /// their chunks and a barrier is behind that; waits there, too. Sorted on return, for every thread.
  void sort(TeamBarrier& barrier, int thread, Range chunk, int count, const UnsortedParticles<Scalar>& from,
            const SortedParticles<Scalar>& to);

 private:
  void sum_keys(int thread, int threads);
  void place_keys(int thread, int threads, int count);

  int keys_;                              ///< cells, held, lost
  std::vector<std::vector<int>> counts_;  ///< per thread and key: a count, then where the thread's next one goes
  std::vector<int> sums_;                 ///< per thread: particles in its share of the keys
  std::vector<int> cell_start_;
};

/// Share `part` of `parts` nearly equal contiguous shares of [0, total).
inline Range share_of(int total, int part, int parts) {
  const auto begin = [&](int index) { return static_cast<int>(std::int64_t{total} * index / parts); };
  return {begin(part), begin(part + 1)};
}

}  // namespace squall::openmp
