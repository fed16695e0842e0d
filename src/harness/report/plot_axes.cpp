#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "harness/report/plot.h"

namespace squall::harness {

namespace {

Range log_range(double low, double high) {
  constexpr double k_room = 0.06;
  const double factor = std::max(1.08, std::pow(high / low, k_room));
  return {low / factor, high * factor};
}

Range linear_range(double low, double high, bool from_zero) {
  constexpr double k_room = 0.06;
  const double room = high > low ? k_room * (high - low) : std::max(k_room, 0.2 * std::abs(high));
  if (from_zero && low >= 0.0) return {0.0, high + std::max(room, k_room * high)};
  return {low - room, high + room};
}

std::vector<double> linear_ticks(const Range& range) {
  constexpr double k_most_steps = 6.0;
  const double raw = (range.high - range.low) / k_most_steps;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = raw <= power         ? power
                      : raw <= 2.0 * power ? 2.0 * power
                      : raw <= 5.0 * power ? 5.0 * power
                                           : 10.0 * power;
  std::vector<double> ticks;
  // Multiples, not sums: no rounding adds up.
  for (double n = std::ceil(range.low / step); n * step <= range.high; n += 1.0) ticks.push_back(n * step);
  return ticks;
}

std::vector<double> log_ticks(const Range& range) {
  constexpr double k_decades_with_twos_and_fives = 3.5;
  const double decades = std::log10(range.high / range.low);
  const std::vector<double> factors =
      decades <= k_decades_with_twos_and_fives ? std::vector<double>{1.0, 2.0, 5.0} : std::vector<double>{1.0};
  const double every = std::max(1.0, std::ceil(decades / 10.0));
  std::vector<double> ticks;
  const double first = std::floor(std::log10(range.low));
  for (double decade = first; std::pow(10.0, decade) <= range.high; decade += every)
    for (const double factor : factors) {
      const double tick = factor * std::pow(10.0, decade);
      if (tick >= range.low && tick <= range.high) ticks.push_back(tick);
    }
  return ticks;
}

}  // namespace

std::string palette_colour(std::size_t index) {
  static constexpr const char* k_colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
  return k_colours[index % std::size(k_colours)];
}

std::string blue_shade(std::size_t index, std::size_t count) {
  constexpr double k_light[] = {74.0, 144.0, 196.0}, k_dark[] = {3.0, 46.0, 97.0};
  const double t = count < 2 ? 1.0 : static_cast<double>(index) / static_cast<double>(count - 1);
  const auto channel = [&](int c) { return static_cast<int>(std::lround(k_light[c] + t * (k_dark[c] - k_light[c]))); };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2));
}

Range axis_range(const std::vector<double>& values, const Axis& axis) {
  std::vector<double> drawn;
  for (const double value : values)
    if (std::isfinite(value) && (!axis.log || value > 0.0)) drawn.push_back(value);
  if (drawn.empty()) return {1.0, 10.0};
  const auto [low, high] = std::minmax_element(drawn.begin(), drawn.end());
  return axis.log ? log_range(*low, *high) : linear_range(*low, *high, axis.from_zero);
}

std::vector<double> axis_ticks(const Range& range, bool log) {
  if (!log) return linear_ticks(range);
  const auto ticks = log_ticks(range);
  // On a short piece of a log axis no power of ten need lie.
  return ticks.size() >= 3 ? ticks : linear_ticks(range);
}

std::vector<double> spread_out(const std::vector<double>& positions, double gap) {
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return positions[a] < positions[b]; });
  std::vector<double> result = positions;
  double least = 0.0;
  for (const std::size_t i : order) {
    result[i] = std::max(result[i], least);
    least = result[i] + gap;
  }
  double most = 1.0;
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    result[*i] = std::min(result[*i], most);
    most = result[*i] - gap;
  }
  return result;
}

}  // namespace squall::harness
