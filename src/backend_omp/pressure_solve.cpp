#include "backend_omp/pressure_solve.h"

#include <algorithm>
#include <chrono>

#include "core/convergence.h"

namespace squall::openmp {

template <class Scalar>
PressureSolve<Scalar>::PressureSolve(const Passes<Scalar>& passes, const Scene::Solver& settings, int threads)
    : passes_(passes), settings_(settings), shares_(std::make_unique<Share[]>(static_cast<std::size_t>(threads))) {}

template <class Scalar>
void PressureSolve<Scalar>::resize(std::size_t count, int threads) {
  for (auto& values : values_) values.resize(count, Scalar(0), threads);
}

template <class Scalar>
SolveArrays<Scalar> PressureSolve<Scalar>::arrays() {
  return {values_[0].data(), values_[1].data(), values_[2].data(), values_[3].data(),
          values_[4].data(), values_[5].data(), values_[6].data(), values_[7].data(),
          values_[8].data(), values_[9].data(), values_[10].data()};
}

template <class Scalar>
SolveSums PressureSolve<Scalar>::total(int threads) const {
  SolveSums sum;
  for (int t = 0; t < threads; ++t) {
    sum.error += shares_[static_cast<std::size_t>(t)].sums.error;
    sum.excess += shares_[static_cast<std::size_t>(t)].sums.excess;
  }
  return sum;
}

/// Between two writes of a thread's sum lies the barrier behind a push or behind predict, and all have read it by then.
template <class Scalar>
typename PressureSolve<Scalar>::Outcome PressureSolve<Scalar>::solve(const Team& team,
                                                                     const PassContext<Scalar>& context, Limits limits,
                                                                     int active, const SolveSums* first) {
  const std::int64_t limit = convergence_limit(limits.tolerance, active);
  const auto [begin, end] = team.rows;
  Momentum momentum;
  for (int iteration = 1;; ++iteration) {
    const auto reach = momentum.next<Scalar>();
    std::int64_t sum = 0;
    if (iteration == 1 && first != nullptr) {
      sum = first->error;
    } else {
      shares_[static_cast<std::size_t>(team.thread)].sums.error = passes_.rate(context, begin, end, team.list, reach);
      team.barrier.wait(team.thread);
      sum = total(team.barrier.threads()).error;
    }
    momentum.found(sum);
    if (sum <= limit && iteration >= limits.least) return {iteration, true};
    if (iteration >= settings_.max_iterations) return {iteration, sum <= limit};
    passes_.push(context, begin, end, team.list);
    team.barrier.wait(team.thread);
  }
}

template <class Scalar>
void PressureSolve<Scalar>::note(Outcome outcome, std::int64_t& sum, int& largest, int& unconverged) const {
  sum += outcome.iterations;
  largest = std::max(largest, outcome.iterations);
  unconverged += outcome.converged ? 0 : 1;
}

template <class Scalar>
bool PressureSolve<Scalar>::make_incompressible(TeamBarrier& barrier, int thread, const PassContext<Scalar>& context,
                                                Range rows, NeighbourList<Scalar>& list, PhaseClock& clock,
                                                FrameReport& report) {
  const bool first = thread == 0;
  Share& share = shares_[static_cast<std::size_t>(thread)];
  SolveSums sums;
  passes_.prepare(context, rows.begin, rows.end, list, sums);
  share.sums = sums;
  share.failed = list.out_of_memory;
  barrier.wait(thread);
  if (first) clock.finish("prepare");
  if (std::any_of(&shares_[0], &shares_[0] + barrier.threads(), [](const Share& each) { return each.failed; }))
    return false;

  const auto start = std::chrono::steady_clock::now();
  const int active = context.cell_start[context.params->cell_count];
  const SolveSums prepared = total(barrier.threads());
  const Team team{barrier, thread, rows, list};
  const Outcome divergence = solve(team, context, {settings_.divergence_tolerance, 1}, active, &prepared);
  if (first) clock.finish("divergence solve");
  const Scalar correction = correction_share(prepared.excess, context.substep->correction, active);
  passes_.predict(context, rows.begin, rows.end, list, correction);
  barrier.wait(thread);
  if (first) clock.finish("predict");
  PassContext<Scalar> predicted = context;
  predicted.sorted = context.next;
  const Outcome density = solve(team, predicted, {settings_.density_tolerance, 2}, active, nullptr);
  if (!first) return true;
  clock.finish("density solve");
  const std::chrono::duration<double, std::milli> light = std::chrono::steady_clock::now() - start;
  report.light_passes_ms += light.count();
  note(divergence, report.divergence_iterations, report.divergence_iterations_max, report.unconverged);
  note(density, report.density_iterations, report.density_iterations_max, report.unconverged);
  return true;
}

template class PressureSolve<float>;
template class PressureSolve<double>;

}  // namespace squall::openmp
