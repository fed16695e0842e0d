#include "harness/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <set>

#include "core/errors.h"
#include "harness/compare.h"
#include "harness/report/plain_text.h"
#include "harness/sweep_analysis.h"
#include "harness/sweep_budget.h"

namespace squall::harness {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string labels_text(const std::vector<RunPlan>& runs) {
  std::string text;
  for (const auto& run : runs) text += (text.empty() ? "" : "; ") + run.label;
  return text;
}

class Sweeper {
 public:
  Sweeper(const SceneAt& scene_at, const SweepPlan& plan, const AfterSweepRound& after_round,
          const AfterSize& after_size)
      : scene_at_(scene_at), plan_(plan), after_round_(after_round), after_size_(after_size), runs_(plan.runs) {
    if (plan_.sizes.empty()) throw InputError("a sweep needs at least one size; name some by --particles");
    std::sort(plan_.sizes.begin(), plan_.sizes.end());
  }

  Sweep run() {
    for (const auto& run : plan_.runs)
      if (run.backend == "opencl") result_.crossovers.push_back({run.label, {}, {}, {}, ""});
    for (std::size_t i = 0; i < plan_.sizes.size() && !result_.interrupted; ++i)
      if (!add_size(scene_at_(plan_.sizes[i]), i)) break;
    finish_crossovers();
    note_threads();
    if (plan_.budget_ms) search_budget();
    return std::move(result_);
  }

 private:
  /// False if no further size is to be measured.
  bool add_size(const SizedScene& scene, std::size_t index) {
    if (!is_new(scene)) return true;
    if (runs_.empty()) return false;
    if (choose_runs(scene.info)) return can_measure(scene, index);
    if (const auto ratio = last_size_with_time(last_size_s_, left_s())) {
      const auto last = static_cast<double>(result_.sizes.back().size.scene_particles);
      const SizedScene smaller = scene_at_(std::llround(*ratio * last));
      if (is_new(smaller)) can_measure(smaller, plan_.sizes.size());
    }
    return false;
  }

  bool is_new(const SizedScene& scene) { return hashes_.insert(scene.info.scene_hash).second; }

  double left_s() const { return *plan_.limit_s - seconds_since(start_); }

  /// Leaves out runs that the time limit has no room for; false if that is all of them.
  bool choose_runs(const SizeInfo& size) {
    if (!plan_.limit_s || result_.sizes.empty()) return true;
    const double ratio =
        static_cast<double>(size.scene_particles) / static_cast<double>(result_.sizes.back().size.scene_particles);
    const auto kept = runs_with_time(run_s_, last_size_s_, ratio, left_s());
    if (kept.size() == runs_.size()) return true;
    std::vector<RunPlan> stay, go;
    for (std::size_t i = 0; i < runs_.size(); ++i)
      (std::find(kept.begin(), kept.end(), i) != kept.end() ? stay : go).push_back(runs_[i]);
    note_time_limit(size, stay.empty() ? "all runs" : labels_text(go));
    if (!stay.empty()) runs_ = stay;
    return !stay.empty();
  }

  void note_time_limit(const SizeInfo& size, const std::string& who) {
    result_.notes.push_back(
        fmt::format("time limit: {} stopped before {} particles; --particles N,N,... takes as long as it takes", who,
                    count_text(size.scene_particles)));
  }

  /// Measures a size; false if it cannot be set up. What was measured before must not be lost to that.
  bool can_measure(const SizedScene& scene, std::size_t index) {
    const auto end = [&](SizeProblem problem, const std::string& why) {
      result_.problem = problem;
      result_.notes.push_back(
          fmt::format("ended before {} particles: {}", count_text(scene.info.scene_particles), why));
      return false;
    };
    try {
      measure(scene, index);
      return true;
    } catch (const InputError& refusal) {
      if (result_.sizes.empty())
        throw InputError(fmt::format("at {} particles, the first size: {}; --particles N,N,... takes others",
                                     count_text(scene.info.scene_particles), refusal.what()));
      return end(SizeProblem::scene, refusal.what());
    } catch (const std::bad_alloc&) {
      if (result_.sizes.empty()) throw;
      return end(SizeProblem::memory, "not enough memory for them");
    }
  }

  void measure(const SizedScene& scene, std::size_t index) {
    const auto size_start = Clock::now();
    const Comparison comparison = compare(scene.make, runs_, [&](int done, int total) {
      return go_on(fmt::format("{} particles, frame {} of {}", count_text(scene.info.scene_particles), done, total),
                   left_of_size(size_start, done, total, index, scene.info.scene_particles));
    });
    last_size_s_ = seconds_since(size_start);
    add(scene.info, comparison);
  }

  void add(const SizeInfo& size, const Comparison& comparison) {
    std::int64_t particles = 0;
    std::vector<SweepPoint> points;
    const auto speedup = speedups(comparison.rows);
    run_s_.clear();
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
      points.push_back({size, comparison.rows[i], speedup[i]});
      particles = std::max(particles, comparison.rows[i].particles);
      run_s_.push_back(comparison.rows[i].wall_s);
    }
    result_.sizes.push_back({size, particles, comparison.agreement});
    result_.points.insert(result_.points.end(), points.begin(), points.end());
    add_leads(comparison);
    drop_failed_devices(comparison);
    if (after_size_) after_size_(points);
  }

  void add_leads(const Comparison& comparison) {
    for (std::size_t i = 0; i < comparison.rows.size(); ++i)
      for (auto& crossover : result_.crossovers)
        if (crossover.label == comparison.rows[i].plan.label)
          if (const auto lead = lead_of(comparison, i)) crossover.leads.push_back(*lead);
  }

  /// A device that failed at one size, for want of memory for example, is not asked for more.
  void drop_failed_devices(const Comparison& comparison) {
    for (std::size_t i = comparison.rows.size(); i-- > 0;) {
      if (!comparison.rows[i].device_failed) continue;
      const auto at = static_cast<std::ptrdiff_t>(i);
      runs_.erase(runs_.begin() + at);
      run_s_.erase(run_s_.begin() + at);
    }
  }

  bool go_on(const std::string& what, double left_s) {
    if (!after_round_) return true;
    const double done_s = seconds_since(start_);
    const bool on = after_round_({what, done_s / std::max(done_s + left_s, 1e-9), left_s});
    result_.interrupted = result_.interrupted || !on;
    return on;
  }

  /// Seconds left of this size and of those that follow, as far as the limit lets them.
  double left_of_size(Clock::time_point size_start, int done, int total, std::size_t index,
                      std::int64_t particles) const {
    const double spent_s = seconds_since(size_start);
    const double size_s = spent_s * total / done;
    double left = size_s - spent_s;
    const double before_s = seconds_since(start_);
    for (std::size_t i = index + 1; i < plan_.sizes.size(); ++i) {
      const double ratio = static_cast<double>(plan_.sizes[i]) / static_cast<double>(particles);
      if (ratio <= 1.0) continue;
      const double next_s = size_s * growth_of_time(ratio);
      if (plan_.limit_s && before_s + left + next_s > *plan_.limit_s) break;
      left += next_s;
    }
    return left;
  }

  void finish_crossovers() {
    for (auto& crossover : result_.crossovers) {
      const auto run = std::find_if(plan_.runs.begin(), plan_.runs.end(),
                                    [&](const RunPlan& plan) { return plan.label == crossover.label; });
      for (const std::size_t i : opponents_of(plan_.runs, static_cast<std::size_t>(run - plan_.runs.begin())))
        crossover.against.push_back(plan_.runs[i].label);
      crossover.crossings = crossings_of(crossover.leads);
      crossover.verdict = crossover_verdict(crossover.leads, crossover.crossings);
    }
  }

  /// A curve named after a thread count must say where it is not one of that many.
  void note_threads() {
    for (const auto& run : plan_.runs) {
      std::string where;
      for (const auto& point : result_.points) {
        const int used = point.row.solver.threads;
        if (point.row.plan.label != run.label || !is_measured(point.row) || used < 1) continue;
        if (used < run.settings.threads)
          where += fmt::format("{}{} at {}", where.empty() ? "" : ", ", used, count_text(point.row.particles));
      }
      if (!where.empty())
        result_.notes.push_back(
            fmt::format("{}: so few particles do not use them all; threads used: {}", run.label, where));
    }
  }

  void search_budget() {
    for (std::size_t i = 0; i < plan_.runs.size(); ++i) {
      const auto& run = plan_.runs[i];
      if (run.backend == "reference") continue;
      BudgetProbe probe;
      probe.real_size = [&](std::int64_t particles) { return scene_at_(particles).info.scene_particles; };
      probe.measure = [&](std::int64_t particles) { return verify(run, particles, plan_.runs.size() - i); };
      result_.budget.push_back(search_largest(run.label, result_.points, *plan_.budget_ms, probe));
    }
  }

  std::optional<SweepPoint> verify(const RunPlan& run, std::int64_t particles, std::size_t runs_left) {
    if (result_.interrupted) return std::nullopt;
    const SizedScene scene = scene_at_(particles);
    const double run_s = *plan_.budget_ms / 1000.0 * (run.frames + run.warm_up_frames);
    const Comparison comparison = compare(scene.make, {run}, [&](int done, int total) {
      return go_on(fmt::format("budget: {} at {} particles, frame {} of {}", run.label,
                               count_text(scene.info.scene_particles), done, total),
                   run_s * (static_cast<double>(runs_left) - static_cast<double>(done) / total));
    });
    if (result_.interrupted) return std::nullopt;
    return SweepPoint{scene.info, comparison.rows.front(), std::nullopt};
  }

  const SceneAt& scene_at_;
  SweepPlan plan_;
  const AfterSweepRound& after_round_;
  const AfterSize& after_size_;
  Clock::time_point start_ = Clock::now();
  std::vector<RunPlan> runs_;  ///< that still take part
  std::vector<double> run_s_;  ///< their seconds at the last size
  double last_size_s_ = 0.0;
  std::set<std::string> hashes_;
  Sweep result_;
};

}  // namespace

std::string count_text(std::int64_t particles) { return readable_number(static_cast<double>(particles)); }

std::string count_text(const SizeInfo& size, std::int64_t particles) {
  const std::string count = count_text(particles);
  return particles == size.scene_particles ? count : count + " of " + count_text(size.scene_particles);
}

bool is_measured(const Row& row) { return row.error.empty() && !row.interrupted && row.frames > 0; }

Sweep sweep(const SceneAt& scene_at, const SweepPlan& plan, const AfterSweepRound& after_round,
            const AfterSize& after_size) {
  return Sweeper(scene_at, plan, after_round, after_size).run();
}

Agreement overall_agreement(const Sweep& sweep) {
  Agreement all;
  int compared = 0;
  for (const auto& size : sweep.sizes) {
    if (!size.agreement.agree) {
      all = size.agreement;
      all.verdict = fmt::format("at {} particles: {}", count_text(size.particles), size.agreement.verdict);
      return all;
    }
    if (!size.agreement.bitwise) continue;
    all.bitwise = true;
    ++compared;
  }
  const bool tolerant = std::any_of(sweep.points.begin(), sweep.points.end(),
                                    [](const SweepPoint& point) { return !point.row.plan.strict; });
  all.verdict = all.bitwise
                    ? fmt::format("the same bits at {} of {} sizes, after every frame", compared, sweep.sizes.size())
                    : "nothing to compare bit by bit: fewer than two strict runs of one precision did a frame";
  if (tolerant && all.bitwise) all.verdict += "; devices that promise no bits within tolerance after the first frame";
  return all;
}

}  // namespace squall::harness
