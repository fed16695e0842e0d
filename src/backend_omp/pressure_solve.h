#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backend_omp/passes.h"
#include "backend_omp/phase_clock.h"
#include "backend_omp/team_array.h"
#include "backend_omp/team_barrier.h"
#include "core/frame_report.h"
#include "core/scene.h"

namespace squall::openmp {

/// dfsph by a team of threads: all of them call make_incompressible(), each for its rows. Every thread decides from the
/// same sums, so all go the same way.
template <class Scalar>
class PressureSolve {
 public:
  PressureSolve(const Passes<Scalar>& passes, const Scene::Solver& settings, int threads);

  /// Room for `count` particles.
  void resize(std::size_t count, int threads);
  SolveArrays<Scalar> arrays();

  /// A sub-step from after the sort up to the drift, which is left to Passes::drift; positions stay. False for all
  /// threads, with nothing changed but `context.sorted`, if one is out of memory for its list. Thread 0 counts
  /// iterations in the report.
  bool make_incompressible(TeamBarrier& barrier, int thread, const PassContext<Scalar>& context, Range rows,
                           NeighbourList<Scalar>& list, PhaseClock& clock, FrameReport& report);

 private:
  struct alignas(64) Share {
    SolveSums sums;
    bool failed = false;
  };
  /// What one thread needs of a solve.
  struct Team {
    TeamBarrier& barrier;
    int thread;
    Range rows;
    const NeighbourList<Scalar>& list;
  };
  struct Limits {
    double tolerance;
    int least;
  };
  struct Outcome {
    int iterations;
    bool converged;
  };

  SolveSums total(int threads) const;
  Outcome solve(const Team& team, const PassContext<Scalar>& context, Limits limits, int active,
                const SolveSums* first);
  void note(Outcome outcome, std::int64_t& sum, int& largest, int& unconverged) const;

  const Passes<Scalar>& passes_;
  Scene::Solver settings_;
  std::unique_ptr<Share[]> shares_;  ///< per thread
  TeamArray<Scalar> values_[11];     ///< those of SolveArrays
};

}  // namespace squall::openmp
