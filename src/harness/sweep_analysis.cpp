#include "harness/sweep_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/report/plain_text.h"

namespace squall::harness {

namespace {

/// Where the line from (a, at_a) to (b, at_b), straight in log(particles), is zero.
double zero_between(double a, double at_a, double b, double at_b) {
  const double share = at_a / (at_a - at_b);
  return a * std::pow(b / a, share);
}

bool leaves_out_one(const Lead& lead) {
  return lead.interval && (lead.interval->low > 1.0 || lead.interval->high < 1.0);
}

bool is_one_thread_of_omp(const RunPlan& plan) { return plan.backend == "omp" && plan.settings.threads == 1; }

std::optional<Interval> paired_ratio(const std::vector<FrameRecord>& slower, const std::vector<FrameRecord>& faster) {
  std::vector<double> ratios;
  for (std::size_t f = 0; f < std::min(slower.size(), faster.size()); ++f)
    if (faster[f].report.frame_ms > 0.0) ratios.push_back(slower[f].report.frame_ms / faster[f].report.frame_ms);
  return median_interval(std::move(ratios));
}

std::string ratio_range(const std::vector<Lead>& leads) {
  const auto [low, high] =
      std::minmax_element(leads.begin(), leads.end(), [](const Lead& a, const Lead& b) { return a.ratio < b.ratio; });
  if (leads.size() == 1) return fmt::format("{:.3g} times its speed", low->ratio);
  return fmt::format("{:.3g} times its speed at {} particles to {:.3g} times at {}", low->ratio,
                     count_text(low->particles), high->ratio, count_text(high->particles));
}

std::string without_crossing(const std::vector<Lead>& leads) {
  const auto all = [&](auto holds) { return std::all_of(leads.begin(), leads.end(), holds); };
  const std::string where = leads.size() == 1
                                ? fmt::format("at {} particles, the only size", count_text(leads[0].particles))
                                : fmt::format("at every size from {} to {} particles",
                                              count_text(leads.front().particles), count_text(leads.back().particles));
  if (all([](const Lead& lead) { return lead.ratio == 1.0; })) return "is as fast as OpenMP " + where;
  const bool ahead = all([](const Lead& lead) { return lead.ratio >= 1.0; });
  return fmt::format("{} {}: {}", ahead ? "is ahead of OpenMP" : "does not overtake OpenMP: behind", where,
                     ratio_range(leads));
}

std::string crossing_text(const Crossing& crossing) {
  return fmt::format(
      "{} at about {} particles (between {} and {})", crossing.overtakes ? "overtakes OpenMP" : "falls behind OpenMP",
      readable_number(crossing.particles), count_text(crossing.between_low), count_text(crossing.between_high));
}

double log_distance(double frame_ms, double budget_ms) { return std::log(frame_ms / budget_ms); }

}  // namespace

std::vector<std::int64_t> size_ladder(std::int64_t own_particles, std::int64_t most) {
  constexpr double k_smallest = 1000.0;
  if (own_particles < 1) return {};
  double size = static_cast<double>(own_particles);
  while (size >= 2.0 * k_smallest) size /= 2.0;
  while (size < k_smallest) size *= 2.0;
  std::vector<std::int64_t> sizes;
  for (; size <= static_cast<double>(most); size *= 2.0) sizes.push_back(std::llround(size));
  return sizes;
}

double growth_of_time(double particles_ratio) { return std::pow(particles_ratio, 4.0 / 3.0); }

std::vector<std::size_t> runs_with_time(const std::vector<double>& run_s, double last_size_s, double particles_ratio,
                                        double left_s) {
  constexpr double k_slow = 4.0;
  if (run_s.empty()) return {};
  const double expected_s = last_size_s * growth_of_time(particles_ratio);
  const double limit_s = expected_s <= left_s ? HUGE_VAL : k_slow * *std::min_element(run_s.begin(), run_s.end());
  double all_s = 0.0, kept_s = 0.0;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < run_s.size(); ++i) {
    all_s += run_s[i];
    if (run_s[i] > limit_s) continue;
    kept_s += run_s[i];
    kept.push_back(i);
  }
  const double share = all_s > 0.0 ? kept_s / all_s : 1.0;
  return expected_s * share <= left_s ? kept : std::vector<std::size_t>{};
}

std::optional<double> last_size_with_time(double last_size_s, double left_s) {
  constexpr double k_reserve = 0.9, k_worth_it = 1.25;
  if (last_size_s <= 0.0 || left_s <= 0.0) return std::nullopt;
  const double ratio = std::pow(k_reserve * left_s / last_size_s, 3.0 / 4.0);
  return ratio >= k_worth_it ? std::optional(ratio) : std::nullopt;
}

std::vector<CurvePoint> curve_of(const std::vector<SweepPoint>& points, const std::string& label) {
  std::map<double, double> curve;
  for (const auto& point : points)
    if (point.row.plan.label == label && is_measured(point.row) && point.row.particles > 0 &&
        point.row.frame_ms.median > 0.0)
      curve[static_cast<double>(point.row.particles)] = point.row.frame_ms.median;
  std::vector<CurvePoint> result;
  for (const auto& [particles, frame_ms] : curve) result.push_back({particles, frame_ms});
  return result;
}

std::vector<std::optional<double>> speedups(const std::vector<Row>& rows) {
  std::vector<std::optional<double>> result(rows.size());
  const auto base =
      std::find_if(rows.begin(), rows.end(), [](const Row& row) { return is_one_thread_of_omp(row.plan); });
  if (base == rows.end() || !is_measured(*base)) return result;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (is_measured(rows[i]) && rows[i].frame_ms.median > 0.0)
      result[i] = base->frame_ms.median / rows[i].frame_ms.median;
  return result;
}

std::vector<std::size_t> opponents_of(const std::vector<RunPlan>& runs, std::size_t opencl_run) {
  std::vector<std::size_t> all, alike;
  const int threads = runs[opencl_run].settings.threads;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].backend != "omp") continue;
    all.push_back(i);
    if (threads > 0 && runs[i].settings.threads == threads) alike.push_back(i);
  }
  return alike.empty() ? all : alike;
}

std::optional<Lead> lead_of(const Comparison& comparison, std::size_t index) {
  const auto& rows = comparison.rows;
  if (!is_measured(rows[index]) || rows[index].frame_ms.median <= 0.0) return std::nullopt;
  std::vector<RunPlan> runs;
  for (const auto& row : rows) runs.push_back(row.plan);
  std::optional<std::size_t> fastest;
  for (const std::size_t i : opponents_of(runs, index))
    if (is_measured(rows[i]) && (!fastest || rows[i].frame_ms.median < rows[*fastest].frame_ms.median)) fastest = i;
  if (!fastest || rows[*fastest].frame_ms.median <= 0.0) return std::nullopt;
  return Lead{rows[index].particles, rows[*fastest].plan.label,
              rows[*fastest].frame_ms.median / rows[index].frame_ms.median,
              paired_ratio(comparison.frames[*fastest], comparison.frames[index])};
}

std::vector<Crossing> crossings_of(const std::vector<Lead>& leads) {
  std::vector<Crossing> crossings;
  std::optional<std::size_t> previous;  // the last size where one of both was ahead
  for (std::size_t i = 0; i < leads.size(); ++i) {
    const double now = std::log(leads[i].ratio);
    if (now == 0.0) continue;
    const double before = previous ? std::log(leads[*previous].ratio) : now;
    if (before * now < 0.0) {
      const Lead &low = leads[*previous], &high = leads[i];
      const auto a = static_cast<double>(low.particles), b = static_cast<double>(high.particles);
      // Where a size between was exactly even, that is where they cross.
      const bool even = i > *previous + 1;
      const double at = even ? static_cast<double>(leads[*previous + 1].particles) : zero_between(a, before, b, now);
      crossings.push_back({at, now > 0.0, low.particles, high.particles, leaves_out_one(low) && leaves_out_one(high)});
    }
    previous = i;
  }
  return crossings;
}

std::string crossover_verdict(const std::vector<Lead>& leads, const std::vector<Crossing>& crossings) {
  if (leads.empty()) return "was measured beside OpenMP at no size";
  std::string text;
  for (const auto& crossing : crossings) text += (text.empty() ? "" : ", ") + crossing_text(crossing);
  if (crossings.empty()) text = without_crossing(leads);
  const bool unsure = std::any_of(crossings.begin(), crossings.end(), [](const Crossing& c) { return !c.sure; });
  if (unsure) text += "; next to a crossing the difference is within the noise, so its place is uncertain";
  if (crossings.empty() && std::none_of(leads.begin(), leads.end(), leaves_out_one))
    text += "; the differences are within the noise";
  return text;
}

BudgetEstimate largest_within(const std::vector<CurvePoint>& curve, double budget_ms) {
  if (curve.empty()) return {};
  if (curve.back().frame_ms <= budget_ms) return {BudgetFit::all, curve.back().particles};
  for (std::size_t i = curve.size() - 1; i > 0; --i) {
    const auto &low = curve[i - 1], &high = curve[i];
    if (low.frame_ms > budget_ms) continue;
    return {BudgetFit::within, zero_between(low.particles, log_distance(low.frame_ms, budget_ms), high.particles,
                                            log_distance(high.frame_ms, budget_ms))};
  }
  return {BudgetFit::none, curve.front().particles};
}

}  // namespace squall::harness
