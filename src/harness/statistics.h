#pragma once

#include <optional>
#include <vector>

namespace squall::harness {

/// Middle value; the mean of the two middle ones for an even count. Throws InputError for no values.
double median(std::vector<double> values);

/// Smallest value that at least the share `q` in (0, 1] of the values does not exceed (nearest rank). Throws InputError
/// for no values or q outside (0, 1].
double quantile(std::vector<double> values, double q);

/// A typical value and how bad it gets.
struct Tail {
  double median = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};
/// All zero for no values.
Tail tail_of(const std::vector<double>& values);

/// [low, high] holds the true median with at least this probability.
struct Interval {
  double low = 0.0, high = 0.0, confidence = 0.0;
};

/// Distribution-free interval for the median: the k-th smallest and k-th largest value, with the largest k for which
/// 1 - 2 P(Binomial(n, 1/2) < k) >= `confidence` (sign test; Conover, Practical Nonparametric Statistics, 3.2). Empty
/// if n values cannot give that confidence (95 % needs six).
std::optional<Interval> median_interval(std::vector<double> values, double confidence = 0.95);

}  // namespace squall::harness
