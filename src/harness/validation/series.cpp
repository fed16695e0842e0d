#include "harness/validation/series.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace squall::harness {

const Column* TimeSeries::find(const std::string& name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const auto& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

std::vector<std::string> TimeSeries::names() const {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  return names;
}

std::optional<double> value_at(const Column& column, double time_s) {
  const auto& times = column.time_s;
  if (times.empty() || !std::isfinite(time_s)) return std::nullopt;
  const auto above = std::lower_bound(times.begin(), times.end(), time_s);
  if (above != times.end() && *above == time_s) {
    const double value = column.value[static_cast<std::size_t>(above - times.begin())];
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  }
  if (times.size() < 2) return std::nullopt;
  const auto at = static_cast<std::size_t>(above - times.begin());
  const std::size_t right = std::clamp<std::size_t>(at, 1, times.size() - 1), left = right - 1;
  const double share = (time_s - times[left]) / (times[right] - times[left]);
  const double reach = column.is_mean ? std::clamp(share, 0.0, 1.0) : share;
  const double value = column.value[left] + reach * (column.value[right] - column.value[left]);
  constexpr double k_rounding = 1e-6;
  if (share < -1.0 - k_rounding || share > 2.0 + k_rounding || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool is_dry_at(const Column& column, double time_s) {
  if (column.is_dry.empty()) return false;
  const auto& times = column.time_s;
  const auto above = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time_s) - times.begin());
  const std::size_t right = std::min(above, times.size() - 1);
  const std::size_t left = right > 0 && times[right] != time_s ? right - 1 : right;
  return column.is_dry[left] && column.is_dry[right];
}

void write_series(std::ostream& out, const TimeSeries& series, const std::vector<double>& times) {
  out << "time_s";
  for (const auto& column : series.columns) out << "," << column.name;
  out << "\n";
  for (const double time : times) {
    fmt::print(out, "{}", time);
    for (const auto& column : series.columns)
      if (const auto value = value_at(column, time))
        fmt::print(out, ",{}", *value);
      else
        out << ",";
    out << "\n";
  }
}

}  // namespace squall::harness
