#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace squall::harness {

/// A quantity over time. Quantities of one run need not share their times: velocities belong to the middle of a
/// sub-step, means over a frame to its middle. NaN where there is no value.
struct Column {
  std::string name, unit;
  std::vector<double> time_s, value;
  bool is_mean = false;           ///< over a span around its time; beyond the ends the outermost value stands
  std::string needs = {};         ///< what must be there for it to have a value, for people; empty: nothing
  std::vector<bool> is_dry = {};  ///< of a pressure at a gauge: it was outside of the water; else empty

  void add(double time, double number) {
    time_s.push_back(time);
    value.push_back(number);
  }
};

/// Everything that was observed of a run.
struct TimeSeries {
  std::vector<Column> columns;

  const Column* find(const std::string& name) const;
  std::vector<std::string> names() const;
};

/// The value at a time [s]: on the straight line between the values around it, and up to one interval beyond the ends
/// on that of the outermost two, or at the value there if it is a mean. Empty further outside, or where a value is
/// missing.
std::optional<double> value_at(const Column& column, double time_s);

/// Whether a gauge was outside of the water at a time: at both samples around it. False for other quantities.
bool is_dry_at(const Column& column, double time_s);

/// CSV: time_s and a column per quantity at the times [s] given; a cell without a value is empty.
void write_series(std::ostream& out, const TimeSeries& series, const std::vector<double>& times);

}  // namespace squall::harness
