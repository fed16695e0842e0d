#include "harness/validation/measure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "harness/measures.h"

namespace squall::harness {

namespace {

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
  return count > 0.0 ? sum / count : k_no_value;
}

/// A distance that is no number (a relative one from 0) is the largest of all.
ComparedPoint furthest(const std::vector<ComparedPoint>& points,
                       const std::function<double(const ComparedPoint&)>& distance) {
  const auto rank = [&](const ComparedPoint& point) {
    const double value = distance(point);
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  };
  return *std::max_element(points.begin(), points.end(),
                           [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

}  // namespace

double point_error(const Check& check, const ComparedPoint& point) {
  const double unit = check.relative ? std::abs(point.expected) : check.scale.value_or(1.0);
  return (point.measured - point.expected) / unit;
}

double rms_error(const Check& check, const std::vector<ComparedPoint>& points) {
  double sum = 0.0;
  for (const auto& p : points) sum += point_error(check, p) * point_error(check, p);
  return std::sqrt(sum / static_cast<double>(points.size()));
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
      finding.error = rms_error(check, points);
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
      const double excess = beyond(finding.worst);
      finding.error = excess < 0.0 ? 0.0 : excess;  // NaN stays NaN
      break;
    }
  }
}

}  // namespace squall::harness
