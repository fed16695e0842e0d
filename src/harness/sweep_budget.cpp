#include "harness/sweep_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/report/plain_text.h"
#include "harness/sweep_analysis.h"

namespace squall::harness {

namespace {

class Search {
 public:
  Search(std::vector<SweepPoint> points, double budget_ms, const BudgetProbe& probe, BudgetResult& result)
      : points_(std::move(points)), budget_ms_(budget_ms), probe_(probe), result_(result) {
    std::erase_if(points_, [](const SweepPoint& point) { return !is_measured(point.row); });
    sort();
  }

  void run() {
    const auto estimate = largest_within(curve(), budget_ms_);
    result_.fit = estimate.fit;
    if (estimate.fit == BudgetFit::within) {
      result_.estimate_particles = estimate.particles;
      constexpr int k_tries = 4;
      for (int tries = 0; tries < k_tries; ++tries)
        if (!improve()) break;
    }
    for (const auto& point : points_)
      if (keeps(point)) result_.largest = point;
    result_.verdict = verdict();
  }

 private:
  bool keeps(const SweepPoint& point) const { return point.row.frame_ms.median <= budget_ms_; }
  std::vector<CurvePoint> curve() const { return curve_of(points_, result_.label); }

  void sort() {
    std::stable_sort(points_.begin(), points_.end(),
                     [](const SweepPoint& a, const SweepPoint& b) { return a.row.particles < b.row.particles; });
  }

  /// Measures between the largest point that keeps the budget and the next; false if that settles it.
  bool improve() {
    const auto size = next_size();
    if (!size) return false;
    const auto point = probe_.measure(*size);
    if (!point) {
      interrupted_ = true;
      return false;
    }
    result_.tried.push_back(*point);
    if (!is_measured(point->row)) return false;
    points_.push_back(*point);
    sort();
    return !keeps(*point);
  }

  /// The size to measure next: the one on the line between both neighbours, or a smaller one if what that scales to is
  /// known to be over the budget. None if there is no other size between them.
  std::optional<std::int64_t> next_size() const {
    std::size_t low = points_.size();
    for (std::size_t i = 0; i + 1 < points_.size(); ++i)
      if (keeps(points_[i]) && !keeps(points_[i + 1])) low = i;
    if (low == points_.size()) return std::nullopt;
    const auto &below = points_[low], &above = points_[low + 1];
    const double particles = largest_within(curve(), budget_ms_).particles;
    // With rain the scene holds more than what has fallen; both grow alike.
    double wanted =
        particles * static_cast<double>(below.size.scene_particles) / static_cast<double>(below.row.particles);
    constexpr double k_step_down = 0.97;
    for (; wanted > static_cast<double>(below.size.scene_particles); wanted *= k_step_down) {
      const std::int64_t real = probe_.real_size(std::llround(wanted));
      if (real <= below.size.scene_particles) break;
      if (real < above.size.scene_particles) return real;
    }
    return std::nullopt;
  }

  std::string tried_text(const SweepPoint& point) const {
    if (!is_measured(point.row)) return "; the run to verify it failed: " + point.row.error;
    if (keeps(point)) return "";
    return fmt::format("; {} took {:.3g} ms", count_text(point.size, point.row.particles), point.row.frame_ms.median);
  }

  std::string verdict() const {
    if (points_.empty()) return "not measured";
    const auto &first = points_.front(), &last = points_.back();
    if (result_.fit == BudgetFit::none)
      return fmt::format("no size fits: {:.3g} ms at the smallest one, {} particles", first.row.frame_ms.median,
                         count_text(first.size, first.row.particles));
    if (result_.fit == BudgetFit::all)
      return fmt::format("every size fits: {:.3g} ms at the largest one, {} particles", last.row.frame_ms.median,
                         count_text(last.size, last.row.particles));
    std::string text = fmt::format("{} particles: {:.3g} ms measured",
                                   count_text(result_.largest->size, result_.largest->row.particles),
                                   result_.largest->row.frame_ms.median);
    text += fmt::format(" ({} interpolated", readable_number(*result_.estimate_particles));
    for (const auto& point : result_.tried) text += tried_text(point);
    return text + (interrupted_ ? "; interrupted before it was verified)" : ")");
  }

  std::vector<SweepPoint> points_;
  double budget_ms_;
  const BudgetProbe& probe_;
  BudgetResult& result_;
  bool interrupted_ = false;
};

}  // namespace

BudgetResult search_largest(const std::string& label, std::vector<SweepPoint> points, double budget_ms,
                            const BudgetProbe& probe) {
  BudgetResult result;
  result.label = label;
  std::erase_if(points, [&](const SweepPoint& point) { return point.row.plan.label != label; });
  Search(std::move(points), budget_ms, probe, result).run();
  return result;
}

}  // namespace squall::harness
