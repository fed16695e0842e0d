#include "harness/validation/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace squall::harness {

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

bool is_in(const Check& check, double time_s) {
  constexpr double k_rounding = 1e-9;
  return time_s >= check.from_s.value_or(-1e30) - k_rounding && time_s <= check.to_s.value_or(1e30) + k_rounding;
}

/// First value of a column from a time on.
double first_value(const Column& column, double from_s) {
  for (std::size_t i = 0; i < column.value.size(); ++i)
    if (column.time_s[i] >= from_s - 1e-9 && std::isfinite(column.value[i])) return column.value[i];
  return k_nan;
}

/// What is expected, at the times at which it is: those of a table, else those of the measured values.
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
    if (!is_in(check, time) || !std::isfinite(measured.value[i])) continue;
    const double value = like != nullptr ? value_at(*like, time).value_or(k_nan) : curve ? curve(time) : start;
    if (std::isfinite(value)) points.push_back({time, value, {}, {}});
  }
  return points;
}

/// Empty if a point lies outside of what was measured.
std::vector<ComparedPoint> compare(const std::vector<ExpectedPoint>& expected, const Column& measured, double shift_s) {
  std::vector<ComparedPoint> points;
  for (const auto& point : expected) {
    const auto value = value_at(measured, point.time_s + shift_s);
    if (!value) return {};
    points.push_back({point.time_s, *value, point.value});
  }
  return points;
}

double point_error(const Check& check, const ComparedPoint& point) {
  const double unit = check.relative ? std::abs(point.expected) : check.scale.value_or(1.0);
  return (point.measured - point.expected) / unit;
}

/// Slope, intercept of the line through measured against expected (least squares).
struct Line {
  double slope = 0.0, offset = 0.0;
};

Line line_through(const std::vector<ComparedPoint>& points) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(points.size());
  for (const auto& p : points) {
    x += p.expected / n;
    y += p.measured / n;
  }
  for (const auto& p : points) {
    xx += (p.expected - x) * (p.expected - x);
    xy += (p.expected - x) * (p.measured - y);
  }
  const double slope = xy / xx;
  return {slope, y - slope * x};
}

/// Mean time between crossings of the mean in the same direction, of both directions; NaN with fewer than one period.
double period_of(const std::vector<ComparedPoint>& points) {
  double mean = 0.0;
  for (const auto& p : points) mean += p.measured / static_cast<double>(points.size());
  std::vector<double> crossings[2];
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double before = points[i - 1].measured - mean, after = points[i].measured - mean;
    if ((before < 0.0) == (after < 0.0)) continue;
    const double share = before / (before - after);
    crossings[after > before].push_back(points[i - 1].time_s + share * (points[i].time_s - points[i - 1].time_s));
  }
  double sum = 0.0, count = 0.0;
  for (const auto& times : crossings) {
    if (times.size() < 2) continue;
    sum += times.back() - times.front();
    count += static_cast<double>(times.size() - 1);
  }
  return count > 0.0 ? sum / count : k_nan;
}

double rms_of(const Check& check, const std::vector<ComparedPoint>& points) {
  double sum = 0.0;
  for (const auto& p : points) sum += point_error(check, p) * point_error(check, p);
  return std::sqrt(sum / static_cast<double>(points.size()));
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
      if (points.empty()) continue;
      const double error = rms_of(check, points);
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

ComparedPoint furthest(const std::vector<ComparedPoint>& points,
                       const std::function<double(const ComparedPoint&)>& distance) {
  return *std::max_element(points.begin(), points.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
}

void measure_points(const Check& check, Finding& finding) {
  const auto& points = finding.points;
  const auto distance = [&](const ComparedPoint& p) { return std::abs(point_error(check, p)); };
  finding.worst = furthest(points, distance);
  const auto n = static_cast<double>(points.size());
  const Line line = line_through(points);
  switch (check.measure) {
    case Measure::max:
      finding.error = distance(finding.worst);
      break;
    case Measure::rms:
      finding.error = rms_of(check, points);
      break;
    case Measure::mean: {
      ComparedPoint mean;
      for (const auto& p : points) {
        finding.error += point_error(check, p) / n;
        mean.measured += p.measured / n;
        mean.expected += p.expected / n;
      }
      mean.time_s = points.back().time_s;
      finding.worst = mean;
      finding.error = std::abs(finding.error);
      break;
    }
    case Measure::slope:
      finding.worst = {points.back().time_s, line.slope, 1.0};
      finding.error = std::abs(line.slope - 1.0);
      break;
    case Measure::line: {
      const auto from_line = [&](const ComparedPoint& p) {
        return std::abs(p.measured - line.offset - line.slope * p.expected) / check.scale.value_or(1.0);
      };
      finding.worst = furthest(points, from_line);
      finding.error = from_line(finding.worst);
      break;
    }
    case Measure::period:
      finding.worst = {points.back().time_s, period_of(points), points.back().expected};
      finding.error = std::abs(point_error(check, finding.worst));
      break;
    case Measure::below:
    case Measure::above: {
      const double sign = check.measure == Measure::below ? 1.0 : -1.0;
      const auto beyond = [&](const ComparedPoint& p) { return sign * point_error(check, p); };
      finding.worst = furthest(points, beyond);
      finding.error = std::max(0.0, beyond(finding.worst));
      break;
    }
  }
}

std::string span_text(const Column& column) {
  return column.time_s.empty() ? "nothing"
                               : fmt::format("{:.4g} to {:.4g} s", column.time_s.front(), column.time_s.back());
}

bool starts_before(const ExpectedPoint& first, const Column& column) {
  return !column.time_s.empty() && first.time_s < column.time_s.front();
}

}  // namespace

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
  finding.error = k_nan;
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
  if (finding.points.empty() || (check.largest_shift_s && !finding.shift_s)) {
    finding.points.clear();
    finding.problem = fmt::format("expected values reach from {:.4g} to {:.4g} s, {} has values over {}: {}",
                                  expected.front().time_s, expected.back().time_s, check.quantity, span_text(*measured),
                                  starts_before(expected.front(), *measured) ? "set from_s" : "lengthen duration_s");
    return finding;
  }
  finding.error = 0.0;
  measure_points(check, finding);
  if (std::isfinite(finding.error)) {
    finding.passed = finding.error <= finding.tolerance;
    return finding;
  }
  finding.problem = check.measure == Measure::period ? "less than one period was seen"
                    : check.measure == Measure::slope || check.measure == Measure::line
                        ? "all expected values are the same: no line through them"
                        : "the error is not finite: a relative error of an expected value of 0 has no meaning";
  return finding;
}

}  // namespace squall::harness
