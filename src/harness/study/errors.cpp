#include "harness/study/errors.h"

#include <algorithm>
#include <cmath>

#include "harness/statistics.h"
#include "harness/study/observables.h"

namespace squall::harness {

namespace {

/// Output times are k frames in each record; frames of other lengths round differently.
bool same_time(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

std::size_t times_until(const Record& record, double until_s) {
  std::size_t count = 0;
  while (count < record.time_s.size() && record.time_s[count] <= until_s * (1.0 + 1e-9)) ++count;
  return count;
}

/// Values over their scale; empty if the record lacks them.
std::vector<double> scaled(const Record& record, const std::string& name) {
  const auto found = record.values.find(name);
  const auto scale = record.scales.find(name);
  if (found == record.values.end() || scale == record.scales.end() || !(scale->second > 0.0)) return {};
  std::vector<double> result = found->second;
  for (double& value : result) value /= scale->second;
  return result;
}

double square(double value) { return value * value; }

/// Mean square of the values that are numbers, of the first `count`; empty if none is.
std::optional<double> mean_square(const std::vector<double>& values, std::size_t count) {
  double sum = 0.0, numbers = 0.0;
  for (std::size_t i = 0; i < std::min(count, values.size()); ++i) {
    if (!std::isfinite(values[i])) continue;
    sum += square(values[i]);
    numbers += 1.0;
  }
  return numbers > 0.0 ? std::optional(sum / numbers) : std::nullopt;
}

/// a - b; NaN where one of them has no value.
std::vector<double> less(std::vector<double> a, const std::vector<double>& b) {
  a.resize(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

/// Least-squares slope of ln(separation) over time, where it grows from the start to the horizon.
std::optional<double> growth_rate(const Growth& growth) {
  constexpr double k_from_dx = 2e-6;
  double count = 0.0, t = 0.0, y = 0.0, tt = 0.0, ty = 0.0;
  for (std::size_t i = 0; i < growth.time_s.size(); ++i) {
    const double d = growth.separation_dx[i];
    if (d > k_horizon_dx) break;
    if (d < k_from_dx) continue;
    const double time = growth.time_s[i], log = std::log(d);
    count += 1.0, t += time, y += log, tt += time * time, ty += time * log;
  }
  const double spread = count * tt - t * t;
  if (count < 3.0 || !(spread > 0.0)) return std::nullopt;
  return (count * ty - t * y) / spread;
}

}  // namespace

std::vector<std::string> parts_of(const std::string& error) {
  if (error != k_combined_error) return {error};
  std::vector<std::string> parts;
  for (const auto& observable : study_observables())
    if (observable.combined) parts.push_back(observable.name);
  return parts;
}

bool has_value(const Record& record, const std::string& observable) {
  const auto values = scaled(record, observable);
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::optional<double> difference(const Record& a, const Record& b, const std::string& error, double until_s) {
  const std::size_t count = times_until(a, until_s);
  if (count != times_until(b, until_s)) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i)
    if (!same_time(a.time_s[i], b.time_s[i])) return std::nullopt;
  double sum = 0.0, parts = 0.0;
  for (const auto& part : parts_of(error)) {
    if (!has_value(a, part) && !has_value(b, part)) continue;
    const auto mean = mean_square(less(scaled(a, part), scaled(b, part)), count);
    if (!mean) return std::nullopt;
    sum += *mean;
    parts += 1.0;
  }
  return parts > 0.0 && std::isfinite(sum) ? std::optional(std::sqrt(sum / parts)) : std::nullopt;
}

std::optional<double> size_of(const Record& record, const std::string& error, double until_s) {
  double sum = 0.0, parts = 0.0;
  for (const auto& part : parts_of(error))
    if (const auto mean = mean_square(scaled(record, part), times_until(record, until_s))) {
      sum += *mean;
      parts += 1.0;
    }
  return parts > 0.0 ? std::optional(std::sqrt(sum / parts)) : std::nullopt;
}

bool is_exact(const std::string& error) {
  const auto& all = study_observables();
  return std::any_of(all.begin(), all.end(), [&](const auto& o) { return o.name == error && o.exact_zero; });
}

std::optional<Noise> noise_of(const std::vector<const Record*>& records, double until_s) {
  if (records.size() < 2) return std::nullopt;
  Noise noise;
  noise.starts = static_cast<int>(records.size());
  const auto n = static_cast<double>(records.size());
  for (const auto& error : error_names()) {
    // The sum of squared differences of all pairs is n (n - 1) variances.
    double sum = 0.0;
    for (std::size_t i = 0; i < records.size(); ++i)
      for (std::size_t j = i + 1; j < records.size(); ++j) {
        const auto apart = difference(*records[i], *records[j], error, until_s);
        sum += apart ? square(*apart) : std::numeric_limits<double>::quiet_NaN();
      }
    if (std::isfinite(sum)) noise.spread[error] = std::sqrt(sum / (n * (n - 1.0)));
  }
  return noise.spread.empty() ? std::nullopt : std::optional(noise);
}

double noise_floor(double spread_a, double spread_b) {
  return 2.0 * std::sqrt(0.5 * (square(spread_a) + square(spread_b)));
}

std::optional<double> separation(const Record& a, const Record& b, std::size_t index) {
  constexpr double k_unit_dx = 1e-9;
  if (index >= a.tracks.size() || index >= b.tracks.size()) return std::nullopt;
  const auto &of_a = a.tracks[index], &of_b = b.tracks[index];
  if (of_a.empty() || of_a.size() != of_b.size()) return std::nullopt;
  std::vector<double> distances;
  for (std::size_t i = 0; i + 2 < of_a.size(); i += 3) {
    const auto dx = static_cast<double>(of_a[i] - of_b[i]), dy = static_cast<double>(of_a[i + 1] - of_b[i + 1]);
    distances.push_back(k_unit_dx * std::hypot(dx, dy, static_cast<double>(of_a[i + 2] - of_b[i + 2])));
  }
  return median(std::move(distances));
}

std::optional<Growth> growth_of(const std::vector<const Record*>& records) {
  if (records.size() < 2) return std::nullopt;
  Growth growth;
  for (std::size_t i = 0; i < records.front()->time_s.size(); ++i) {
    std::vector<double> apart;
    for (std::size_t r = 1; r < records.size(); ++r)
      if (const auto distance = separation(*records.front(), *records[r], i)) apart.push_back(*distance);
    if (apart.empty()) break;
    growth.time_s.push_back(records.front()->time_s[i]);
    growth.separation_dx.push_back(median(std::move(apart)));
    if (growth.separation_dx.back() >= k_horizon_dx) growth.horizon_reached = true;
    if (!growth.horizon_reached) growth.horizon_s = growth.time_s.back();
  }
  if (growth.time_s.empty()) return std::nullopt;
  growth.rate_per_s = growth_rate(growth);
  return growth;
}

std::optional<double> order_of(double h1, double h2, double h3, double d12, double d23) {
  constexpr double k_lowest = 0.05, k_highest = 8.0;
  if (!(h1 > h2 && h2 > h3 && h3 > 0.0 && d12 > 0.0 && d23 > 0.0)) return std::nullopt;
  const auto excess = [&](double p) {  // rises with p
    const double coarse = std::pow(h1 / h2, p) - 1.0, fine = 1.0 - std::pow(h3 / h2, p);
    return std::log(coarse / fine) - std::log(d12 / d23);
  };
  double low = k_lowest, high = k_highest;
  if (!(excess(low) < 0.0) || !(excess(high) > 0.0)) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace squall::harness
