#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/compare.h"
#include "harness/sweep.h"

namespace squall::harness {

/// A measured frame time.
struct CurvePoint {
  double particles = 0.0;
  double frame_ms = 0.0;  ///< median
};

/// Sizes to try when nobody names them: the scene's own count times powers of two, from [1000, 2000) up to `most`.
std::vector<std::int64_t> size_ladder(std::int64_t own_particles, std::int64_t most);

/// How the seconds of a size grow with its particles: as N^(4/3), since sub-steps are as long as the spacing.
double growth_of_time(double particles_ratio);

/// Which runs the next size has time for, by index into `run_s`, their seconds at the last size: all; else those that
/// take at most four times as long as the fastest, so that one slow run does not end the range of the others; else
/// none.
std::vector<std::size_t> runs_with_time(const std::vector<double>& run_s, double last_size_s, double particles_ratio,
                                        double left_s);

/// The size that fills the time left, all runs included, as a multiple of the last one; empty if it would hardly be
/// larger.
std::optional<double> last_size_with_time(double last_size_s, double left_s);

/// The curve of one run, ascending in particles, without rows that are not measured. Of equal sizes the last counts.
std::vector<CurvePoint> curve_of(const std::vector<SweepPoint>& points, const std::string& label);

/// Speed-up of every row against the one of omp with one thread; empty where one of both is not measured.
std::vector<std::optional<double>> speedups(const std::vector<Row>& rows);

/// The OpenMP runs that an OpenCL run is held against, by index.
std::vector<std::size_t> opponents_of(const std::vector<RunPlan>& runs, std::size_t opencl_run);

/// The OpenCL run `index` of a comparison against the fastest of its opponents; empty if either is not measured.
std::optional<Lead> lead_of(const Comparison& comparison, std::size_t index);

/// Crossings of ratio 1, on lines between neighbours in log-log.
std::vector<Crossing> crossings_of(const std::vector<Lead>& leads);

/// The sentence about leads and their crossings.
std::string crossover_verdict(const std::vector<Lead>& leads, const std::vector<Crossing>& crossings);

/// How many particles keep a budget, on lines between neighbours in log-log: the largest count where the curve goes
/// above it.
struct BudgetEstimate {
  BudgetFit fit = BudgetFit::not_measured;
  double particles = 0.0;  ///< within: the count; all: the largest measured
};
BudgetEstimate largest_within(const std::vector<CurvePoint>& curve, double budget_ms);

}  // namespace squall::harness
