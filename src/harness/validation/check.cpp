#include "harness/validation/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/measures.h"
#include "harness/validation/measure.h"

namespace squall::harness {

namespace {

/// First value of a column from a time on.
double first_value(const Column& column, double from_s) {
  for (std::size_t i = 0; i < column.value.size(); ++i)
    if (column.time_s[i] >= from_s - 1e-9 && std::isfinite(column.value[i])) return column.value[i];
  return k_no_value;
}

/// What is expected, at the times at which it is: those of a table, else those of the samples; NaN where what it should
/// be like has no value.
std::vector<ExpectedPoint> expected_points(const Check& check, const Scene& scene, const TimeSeries& series,
                                           const Column& measured) {
  std::vector<ExpectedPoint> points;
  if (!check.expected.points.empty()) {
    for (const auto& point : check.expected.points)
      if (is_in(check, point.time_s)) points.push_back(point);
    return points;
  }
  const Column* like = check.expected.like.empty() ? nullptr : series.find(check.expected.like);
  const Curve curve = expected_curve(check, scene);
  const double start = first_value(measured, check.from_s.value_or(-1e30));
  for (std::size_t i = 0; i < measured.value.size(); ++i) {
    const double time = measured.time_s[i];
    if (!is_in(check, time)) continue;
    const double value = like != nullptr ? value_at(*like, time).value_or(k_no_value) : curve ? curve(time) : start;
    points.push_back({time, value, {}, {}});
  }
  return points;
}

std::vector<ComparedPoint> compare(const std::vector<ExpectedPoint>& expected, const Column& measured, double shift_s) {
  std::vector<ComparedPoint> points;
  for (const auto& point : expected)
    points.push_back({point.time_s, value_at(measured, point.time_s + shift_s).value_or(k_no_value), point.value});
  return points;
}

bool is_missing(const ComparedPoint& point) { return !std::isfinite(point.measured) || !std::isfinite(point.expected); }

bool any_missing(const std::vector<ComparedPoint>& points) {
  return std::any_of(points.begin(), points.end(), is_missing);
}

/// The shift with the smallest rms error for which every point can be compared: a scan, then a finer one around the
/// best.
std::optional<double> best_shift(const Check& check, const std::vector<ExpectedPoint>& expected,
                                 const Column& measured) {
  constexpr int k_steps = 100;
  double centre = 0.0, reach = *check.largest_shift_s, least = std::numeric_limits<double>::infinity();
  std::optional<double> best;
  for (int pass = 0; pass < 3; ++pass) {
    for (int i = -k_steps; i <= k_steps; ++i) {
      const double shift = std::clamp(centre + reach * i / k_steps, -*check.largest_shift_s, *check.largest_shift_s);
      const auto points = compare(expected, measured, shift);
      if (any_missing(points)) continue;
      const double error = rms_error(check, points);
      if (!(error < least)) continue;
      least = error;
      best = shift;
    }
    if (!best) return best;
    centre = *best;
    reach *= 2.0 / k_steps;
  }
  return best;
}

std::string span_text(const Column& column) {
  return column.time_s.empty() ? "nothing"
                               : fmt::format("{:.4g} to {:.4g} s", column.time_s.front(), column.time_s.back());
}

/// Beyond an end of what was measured, where that end itself has a value.
bool is_outside(const Column& column, double time_s) {
  if (column.time_s.empty()) return true;
  return (time_s < column.time_s.front() && std::isfinite(column.value.front())) ||
         (time_s > column.time_s.back() && std::isfinite(column.value.back()));
}

std::string needs_text(const Column& column) {
  return column.needs.empty() ? "" : fmt::format("; it needs {}", column.needs);
}

/// Why points cannot be compared; empty if they can.
std::string missing_text(const Check& check, const Column& measured, const TimeSeries& series, const Finding& finding) {
  const auto& points = finding.points;
  const auto first = std::find_if(points.begin(), points.end(), is_missing);
  if (first == points.end()) return "";
  const auto count = std::count_if(points.begin(), points.end(), is_missing);
  if (is_outside(measured, first->time_s + finding.shift_s.value_or(0.0)))
    return fmt::format("expected values reach from {:.4g} to {:.4g} s, {} has values over {}: {}",
                       points.front().time_s, points.back().time_s, check.quantity, span_text(measured),
                       first->time_s < measured.time_s.front() ? "set from_s" : "lengthen duration_s");
  const std::string where = fmt::format("at {} of {} times, first at {:.4g} s", count, points.size(), first->time_s);
  constexpr const char* k_advice = ": compare when there is some (from_s, to_s), or mend the scene";
  if (!std::isfinite(first->measured))
    return fmt::format("{} has no value {}{}{}", check.quantity, where, needs_text(measured), k_advice);
  if (const Column* like = series.find(check.expected.like))
    return fmt::format("{}, which it should be like, has no value {}{}{}", like->name, where, needs_text(*like),
                       k_advice);
  return fmt::format("formula {} gives no finite number {}", check.expected.formula, where);
}

/// Why what was compared says nothing, though it has values; empty if it does.
std::string emptiness_text(const Check& check, const Column& measured, const Finding& finding) {
  const double shift_s = finding.shift_s.value_or(0.0);
  const auto& points = finding.points;
  if (std::all_of(points.begin(), points.end(),
                  [&](const auto& point) { return is_dry_at(measured, point.time_s + shift_s); }))
    return fmt::format(
        "gauge {} was outside of the water from {:.4g} to {:.4g} s, where it shows 0 whatever happens: move it into "
        "the water; that a place stays dry is for a level gauge to check",
        check.quantity, points.front().time_s, points.back().time_s);
  if (check.expected.formula == "start" && points.size() < 2)
    return "there is only the start itself between from_s and to_s; leave it time to change";
  return "";
}

std::string infinite_text(const Check& check) {
  if (check.measure == Measure::period) return "less than one period was seen";
  if (check.measure == Measure::slope || check.measure == Measure::line)
    return "all expected values are the same: no line through them";
  return "the error is not finite: a relative error of an expected value of 0 has no meaning";
}

}  // namespace

bool is_in(const Check& check, double time_s) {
  constexpr double k_rounding = 1e-9;
  return time_s >= check.from_s.value_or(-1e30) - k_rounding && time_s <= check.to_s.value_or(1e30) + k_rounding;
}

double tolerance_of(const Check& check, double spacing_m) {
  return check.tolerance + check.tolerance_dx * spacing_m / check.scale.value_or(1.0);
}

std::string error_unit(const Check& check, const std::string& quantity_unit) {
  if (check.relative || check.scale || check.measure == Measure::slope) return "1";
  return check.measure == Measure::period ? "s" : quantity_unit;
}

Curve expected_curve(const Check& check, const Scene& scene) {
  if (check.expected.value) return [value = *check.expected.value](double) { return value; };
  if (check.expected.formula.empty() || check.expected.formula == "start") return {};
  return make_curve(check.expected.formula, {scene, check.quantity, check.expected.parameters});
}

Finding judge(const Check& check, const Scene& scene, const TimeSeries& series) {
  Finding finding;
  finding.tolerance = tolerance_of(check, scene.fluid.spacing_m);
  finding.error = k_no_value;
  finding.lacks_values = true;
  const Column* measured = series.find(check.quantity);
  if (measured == nullptr) {
    finding.problem = check.quantity + " was not measured";
    return finding;
  }
  const auto expected = expected_points(check, scene, series, *measured);
  if (expected.empty()) {
    finding.problem = fmt::format("nothing to compare between from_s and to_s; {} was measured over {}", check.quantity,
                                  span_text(*measured));
    return finding;
  }
  if (check.largest_shift_s) finding.shift_s = best_shift(check, expected, *measured);
  finding.points = compare(expected, *measured, finding.shift_s.value_or(0.0));
  finding.worst = *std::max_element(finding.points.begin(), finding.points.end(),
                                    [](const auto& a, const auto& b) { return is_missing(a) < is_missing(b); });
  finding.problem = missing_text(check, *measured, series, finding);
  if (finding.problem.empty()) finding.problem = emptiness_text(check, *measured, finding);
  finding.lacks_values = !finding.problem.empty();
  if (finding.lacks_values) return finding;
  finding.error = 0.0;
  measure_points(check, finding);
  if (std::isfinite(finding.error))
    finding.passed = finding.error <= finding.tolerance;
  else
    finding.problem = infinite_text(check);
  return finding;
}

}  // namespace squall::harness
