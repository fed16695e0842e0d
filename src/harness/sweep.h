#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/agreement.h"
#include "harness/row.h"
#include "harness/run.h"

namespace squall::harness {

/// A scene at one spacing.
struct SizeInfo {
  std::int64_t scene_particles = 0;  ///< at the start plus all that rain may add
  double spacing_m = 0.0;
  std::string scene_hash;
};

/// A scene at one size, ready to run.
struct SizedScene {
  SizeInfo info;
  SolverFactory make;
};

/// Scales the scene to the size nearest to a number of particles. Throws InputError if it cannot be scaled.
using SceneAt = std::function<SizedScene(std::int64_t particles)>;

/// What a sweep measures: every run at every size, the runs of a size interleaved as compare() does it.
struct SweepPlan {
  std::vector<RunPlan> runs;        ///< with the same frames and warm-up frames
  std::vector<std::int64_t> sizes;  ///< particles asked for; done in ascending order
  std::optional<double> limit_s;    ///< sizes that would take longer than this in all are left out
  std::optional<double> budget_ms;  ///< search the largest scene that keeps this median frame time
};

/// One run at one size. `row.particles` are those at the end of the measured frames: with rain fewer than the scene's.
struct SweepPoint {
  SizeInfo size;
  Row row;
  std::optional<double> speedup;  ///< against omp with one thread at this size
};

/// One OpenCL run beside OpenMP at one size.
struct Lead {
  std::int64_t particles = 0;
  std::string against;               ///< the OpenMP run it is held against, the fastest at this size
  double ratio = 1.0;                ///< its median frame time over ours: above 1, OpenCL is ahead
  std::optional<Interval> interval;  ///< of the median ratio of equal frames, which interleaving pairs
};

/// Where the curves of two backends cross.
struct Crossing {
  double particles = 0.0;                          ///< interpolated, linear in the logarithms
  bool overtakes = true;                           ///< OpenCL is ahead above; else it falls behind there
  std::int64_t between_low = 0, between_high = 0;  ///< measured sizes around it
  bool sure = false;                               ///< on both sides the interval of the ratio leaves 1 out
};

/// An OpenCL run against the OpenMP runs: those of as many threads if it was given a number of them, else all.
struct Crossover {
  std::string label;
  std::vector<std::string> against;
  std::vector<Lead> leads;  ///< a line per size, ascending
  std::vector<Crossing> crossings;
  std::string verdict;  ///< one sentence
};

enum class BudgetFit { not_measured, none, within, all };

/// The largest scene of one run within the budget.
struct BudgetResult {
  std::string label;
  BudgetFit fit = BudgetFit::not_measured;
  std::optional<double> estimate_particles;  ///< interpolated on the sweep's curve, before it was verified
  std::optional<SweepPoint> largest;         ///< largest that was measured to keep it
  std::vector<SweepPoint> tried;             ///< runs made for this, in their order
  std::string verdict;
};

/// Why a size could not be set up: the scene is refused at it (a grid too large), or the machine has no memory for it.
enum class SizeProblem { none, scene, memory };

struct SweepSize {
  SizeInfo size;
  std::int64_t particles = 0;  ///< at the end of the measured frames
  Agreement agreement;
};

struct Sweep {
  std::vector<SweepSize> sizes;    ///< ascending
  std::vector<SweepPoint> points;  ///< size by size, in the order of the runs
  std::vector<Crossover> crossovers;
  std::vector<BudgetResult> budget;  ///< empty without a budget
  std::vector<std::string> notes;    ///< what was left out, and why
  bool interrupted = false;
  SizeProblem problem = SizeProblem::none;  ///< what ended it before its last size
};

struct SweepProgress {
  std::string what;  ///< "24,334 particles, frame 12 of 35"
  double share = 0.0;
  double left_s = 0.0;
};

/// Called after every frame of all runs; false ends the sweep, with what was measured until then.
using AfterSweepRound = std::function<bool(const SweepProgress& progress)>;

/// Called with the points of a size when it is done.
using AfterSize = std::function<void(const std::vector<SweepPoint>& points)>;

/// Measures a scene over sizes and works out speed-ups, crossovers and the largest scenes within the budget. Two sizes
/// asked for that scale to the same scene are measured once. A size that cannot be set up ends the sweep with what was
/// measured; the first one throws InputError or std::bad_alloc. Throws InputError for no sizes and what compare()
/// refuses.
Sweep sweep(const SceneAt& scene_at, const SweepPlan& plan, const AfterSweepRound& after_round = {},
            const AfterSize& after_size = {});

/// A number of particles for people: "11,664"; with rain "58 of 2,000", those that have fallen of those of the scene.
std::string count_text(std::int64_t particles);
std::string count_text(const SizeInfo& size, std::int64_t particles);

/// Whether a row has its planned numbers: no error, not cut short.
bool is_measured(const Row& row);

/// All sizes together in one verdict: bitwise and agree only if every size does; else the first size that differs.
Agreement overall_agreement(const Sweep& sweep);

}  // namespace squall::harness
