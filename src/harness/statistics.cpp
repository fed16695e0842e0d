#include "harness/statistics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/errors.h"

namespace squall::harness {

namespace {

void require_values(const std::vector<double>& values) {
  if (values.empty()) throw InputError("a median or quantile needs at least one value; there is none");
}

}  // namespace

double median(std::vector<double> values) {
  require_values(values);
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double quantile(std::vector<double> values, double q) {
  require_values(values);
  if (!(q > 0.0 && q <= 1.0)) throw InputError("quantile " + std::to_string(q) + " is outside (0, 1]");
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  return values[std::min(values.size(), static_cast<std::size_t>(std::max(1.0, rank))) - 1];
}

Tail tail_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  return {median(values), quantile(values, 0.95), quantile(values, 0.99), quantile(values, 1.0)};
}

std::optional<Interval> median_interval(std::vector<double> values, double confidence) {
  const std::size_t n = values.size();
  std::sort(values.begin(), values.end());
  std::optional<Interval> best;
  double term = std::exp2(-static_cast<double>(n));  // P(Binomial(n, 1/2) = k - 1), k = 1
  double below = term;                               // P(Binomial(n, 1/2) < k)
  for (std::size_t k = 1; 2 * k <= n; ++k) {
    const double reached = 1.0 - 2.0 * below;
    if (reached < confidence) break;
    best = Interval{values[k - 1], values[n - k], reached};
    term *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    below += term;
  }
  return best;
}

}  // namespace squall::harness
