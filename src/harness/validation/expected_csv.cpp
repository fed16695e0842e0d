#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "core/errors.h"
#include "harness/validation/case.h"

namespace squall::harness {

namespace {

using Table = std::map<std::string, std::vector<ExpectedPoint>>;

std::string trimmed(const std::string& text) {
  constexpr const char* k_blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(k_blanks), last = text.find_last_not_of(k_blanks);
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream rest(line + ",");
  for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(trimmed(cell));
  return cells;
}

std::optional<double> number_in(const std::string& cell, const std::string& where) {
  if (cell.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    throw InputError(where + "'" + cell + "' is not a finite number");
  return value;
}

std::optional<std::size_t> position_of(const std::vector<std::string>& header, const std::string& name) {
  for (std::size_t i = 0; i < header.size(); ++i)
    if (header[i] == name) return i;
  return std::nullopt;
}

bool is_spread(const std::vector<std::string>& header, const std::string& name) {
  for (const std::string end : {"_low", "_high"})
    if (name.size() > end.size() && name.ends_with(end) &&
        position_of(header, name.substr(0, name.size() - end.size())))
      return true;
  return false;
}

void check_header(const std::vector<std::string>& header, const std::string& where) {
  if (header.size() < 2 || header.front() != "time_s")
    throw InputError(where + "the first line must be a header: time_s, then the names of quantities");
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].empty()) throw InputError(where + fmt::format("column {} has no name", i + 1));
    if (position_of(header, header[i]) != i) throw InputError(where + "column '" + header[i] + "' is there twice");
  }
}

void check_order(double time_s, const std::string& where, const std::optional<double>& before) {
  if (const std::string problem = order_problem(before, time_s); !problem.empty()) throw InputError(where + problem);
}

void add_line(const std::vector<std::string>& header, const std::vector<std::string>& cells, const std::string& where,
              std::optional<double>& last_time, Table& table) {
  if (cells.size() != header.size())
    throw InputError(where + fmt::format("this line has {} cells, the header {}", cells.size(), header.size()));
  const auto time = number_in(cells.front(), where);
  if (!time) throw InputError(where + "the time is missing");
  check_order(*time, where, last_time);
  last_time = time;
  for (std::size_t i = 1; i < header.size(); ++i) {
    const auto value = number_in(cells[i], where);
    if (is_spread(header, header[i]) || !value) continue;
    const auto low = position_of(header, header[i] + "_low"), high = position_of(header, header[i] + "_high");
    const ExpectedPoint point{*time, *value, low ? number_in(cells[*low], where) : std::nullopt,
                              high ? number_in(cells[*high], where) : std::nullopt};
    if (const std::string problem = spread_problem(point); !problem.empty())
      throw InputError(where + header[i] + ": " + problem);
    table[header[i]].push_back(point);
  }
}

}  // namespace

std::string order_problem(const std::optional<double>& before_s, double time_s) {
  if (!before_s || time_s > *before_s) return "";
  if (time_s == *before_s)
    return fmt::format("time {} is there twice; give each time once, the mean of its values", time_s);
  return fmt::format("time {} comes after {}; sort the table, times rise", time_s, *before_s);
}

std::string spread_problem(const ExpectedPoint& point) {
  const bool right = point.low.value_or(point.value) <= point.value && point.value <= point.high.value_or(point.value);
  if (right) return "";
  return fmt::format("value {} must lie between its low ({}) and high ({})", point.value,
                     point.low ? fmt::format("{}", *point.low) : "none",
                     point.high ? fmt::format("{}", *point.high) : "none");
}

Table parse_expected_csv(const std::string& text, const std::string& path) {
  std::istringstream lines(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
  std::vector<std::string> header;
  Table table;
  std::optional<double> last_time;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string where = fmt::format("{}:{}: ", path, number);
    if (line.starts_with("#") || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto cells = cells_of(line);
    if (!header.empty()) {
      add_line(header, cells, where, last_time, table);
      continue;
    }
    check_header(cells, where);
    header = cells;
    for (std::size_t i = 1; i < header.size(); ++i)
      if (!is_spread(header, header[i])) table[header[i]] = {};
  }
  if (header.empty()) throw InputError(path + ": the table is empty; it starts with a header: time_s, quantity, ...");
  for (const auto& [name, points] : table)
    if (points.empty()) throw InputError(path + ": column '" + name + "' has no value");
  return table;
}

}  // namespace squall::harness
