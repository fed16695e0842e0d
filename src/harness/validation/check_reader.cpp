#include "harness/validation/check_reader.h"

#include <algorithm>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "harness/validation/check.h"
#include "harness/validation/formulas.h"
#include "harness/validation/observer.h"

namespace squall::harness {

namespace {

/// From the units of a table to SI.
struct Units {
  double time_scale_s = 1.0, time_offset_s = 0.0, value_scale = 1.0, value_offset = 0.0;

  ExpectedPoint operator()(const ExpectedPoint& p) const {
    const auto convert = [this](double value) { return value_offset + value_scale * value; };
    ExpectedPoint result{time_offset_s + time_scale_s * p.time_s, convert(p.value), {}, {}};
    if (p.low) result.low = convert(*p.low);
    if (p.high) result.high = convert(*p.high);
    if (value_scale < 0.0) std::swap(result.low, result.high);
    return result;
  }
};

void check_quantity(const TableReader& reader, const char* key, const std::string& name, const Scene& scene) {
  const auto names = quantity_names(scene);
  if (std::find(names.begin(), names.end(), name) == names.end())
    reader.fail(
        key, fmt::format("{} '{}' is unknown; did you mean '{}'? It is the name of a gauge of the scene (of a velocity "
                         "with _x, _y or _z), or one of those that `squall validate --list` prints",
                         key, name, nearest_name(name, names)));
}

void read_points(TableReader& reader, Expectation& expected) {
  const toml::node* node = reader.node("points");
  if (node == nullptr) return;
  const std::string wanted = "points must be an array of [time, value] or [time, value, low, high]";
  if (!node->is_array() || node->as_array()->empty()) reader.fail("points", wanted);
  for (const auto& entry : *node->as_array()) {
    std::vector<double> numbers;
    if (const auto* array = entry.as_array())
      for (const auto& cell : *array)
        if (const auto number = number_of(cell)) numbers.push_back(*number);
    const bool right = entry.is_array() && numbers.size() == entry.as_array()->size();
    if (!right || (numbers.size() != 2 && numbers.size() != 4)) reader.fail_at(entry, wanted);
    ExpectedPoint point{numbers[0], numbers[1], {}, {}};
    if (numbers.size() == 4) {
      point.low = numbers[2];
      point.high = numbers[3];
    }
    const auto before = expected.points.empty() ? std::nullopt : std::optional(expected.points.back().time_s);
    if (const std::string problem = order_problem(before, point.time_s); !problem.empty())
      reader.fail_at(entry, problem);
    if (const std::string problem = spread_problem(point); !problem.empty()) reader.fail_at(entry, problem);
    expected.points.push_back(point);
  }
}

void read_table(TableReader& reader, const CaseFiles& files, Check& check) {
  std::optional<std::string> file;
  reader.optional("table", file);
  std::string column = check.quantity;
  reader.optional("column", column);
  if (!file) {
    if (reader.has("column")) reader.fail("column", "column belongs to table");
    return;
  }
  const std::string path = files.beside(*file);
  std::string text;
  try {
    text = files.read(path);
  } catch (const InputError& error) {
    reader.fail("table", error.what());
  }
  const auto table = parse_expected_csv(text, path);
  const auto found = table.find(column);
  if (found == table.end()) {
    std::vector<std::string> names;
    for (const auto& [name, points] : table) names.push_back(name);
    reader.fail(reader.has("column") ? "column" : "table",
                fmt::format("{} has no column '{}'; it has {}", path, column, fmt::join(names, ", ")));
  }
  check.expected.points = found->second;
}

void read_expectation(TableReader& reader, const CaseFiles& files, Check& check) {
  int ways = 0;
  for (const char* key : {"value", "points", "table", "formula", "like"}) ways += reader.has(key) ? 1 : 0;
  if (ways != 1)
    reader.fail("quantity", fmt::format("{} needs exactly one of value, points, table, formula, like; it has {}",
                                        reader.text(), ways));
  Units units;
  reader.number("time_scale_s", units.time_scale_s, 1e-12, 1e12);
  reader.number("time_offset_s", units.time_offset_s, -1e6, 1e6);
  reader.number("value_scale", units.value_scale, -1e12, 1e12);
  reader.number("value_offset", units.value_offset, -1e12, 1e12);
  reader.optional("value", check.expected.value);
  reader.optional("formula", check.expected.formula);
  reader.optional("like", check.expected.like);
  read_points(reader, check.expected);
  read_table(reader, files, check);
  for (auto& point : check.expected.points) point = units(point);
  if (check.expected.points.empty() && (reader.has("time_scale_s") || reader.has("time_offset_s") ||
                                        reader.has("value_scale") || reader.has("value_offset")))
    reader.fail("quantity", "time_scale_s, time_offset_s, value_scale and value_offset belong to points and table");
}

Measure measure_at(const TableReader& reader, const std::string& text) {
  std::string names;
  for (const Measure measure : {Measure::max, Measure::rms, Measure::mean, Measure::slope, Measure::line,
                                Measure::period, Measure::below, Measure::above}) {
    if (text == to_string(measure)) return measure;
    names += std::string(names.empty() ? "" : ", ") + to_string(measure);
  }
  reader.fail("measure", fmt::format("measure '{}' is unknown; there are {}", text, names));
}

void read_measure(TableReader& reader, Check& check) {
  std::string measure = "max";
  reader.optional("measure", measure);
  check.measure = measure_at(reader, measure);
  reader.optional("relative", check.relative);
  reader.number("scale", check.scale, 1e-12, 1e12);
  if (check.relative && check.scale) reader.fail("scale", "an error is relative or has a scale, not both");
  if (!reader.has("tolerance") && !reader.has("tolerance_dx"))
    reader.fail("quantity", reader.text() + " needs tolerance, tolerance_dx or both");
  reader.number("tolerance", check.tolerance, 0.0, 1e12);
  reader.number("tolerance_dx", check.tolerance_dx, 0.0, 1e6);
  reader.required("tolerance_why", check.tolerance_why);
  if (check.tolerance_dx > 0.0 &&
      (check.relative || check.measure == Measure::slope || check.measure == Measure::period))
    reader.fail("tolerance_dx", "tolerance_dx is for errors that are lengths, absolute or with a scale");
}

/// Tries the formula out, so that what is wrong is said with its place in the file.
void read_formula(TableReader& reader, Check& check, const Case& of) {
  const toml::node* node = reader.node("parameters");
  if (node != nullptr) {
    if (!reader.has("formula") || !node->is_table())
      reader.fail("parameters", "parameters is a table of numbers that belongs to formula");
    for (const auto& [key, entry] : *node->as_table()) {
      const auto number = number_of(entry);
      if (!number) reader.fail_at(entry, fmt::format("parameter {} must be a finite number", key.str()));
      check.expected.parameters[std::string(key.str())] = *number;
    }
  }
  if (!reader.has("formula") || check.expected.formula == "start") return;
  try {
    const Curve curve = make_curve(check.expected.formula, {of.scene, check.quantity, check.expected.parameters});
    curve(std::min(check.to_s.value_or(1e6), duration_of(of)));  // as far as it will be asked for
  } catch (const InputError& error) {
    reader.fail("formula", error.what());
  }
}

void read_like(TableReader& reader, const Check& check, const Scene& scene) {
  if (!reader.has("like")) return;
  check_quantity(reader, "like", check.expected.like, scene);
  if (check.expected.like == check.quantity)
    reader.fail("like", fmt::format("{} is always like itself; name another quantity, or formula = \"start\" for what "
                                    "should not change",
                                    check.quantity));
}

std::vector<ExpectedPoint> counted_points(const Check& check) {
  auto points = check.expected.points;
  std::erase_if(points, [&](const ExpectedPoint& point) { return !is_in(check, point.time_s); });
  return points;
}

/// What lies beyond the run would never be looked at.
void read_span(TableReader& reader, Check& check, const Case& of) {
  reader.number("from_s", check.from_s, 0.0, 1e6);
  reader.number("to_s", check.to_s, 0.0, 1e6);
  reader.number("largest_shift_s", check.largest_shift_s, 0.0, 1e6);
  const double end_s = duration_of(of);
  for (const auto& [key, value] : {std::pair{"from_s", check.from_s}, std::pair{"to_s", check.to_s}})
    if (value.value_or(0.0) > end_s * (1.0 + 1e-9))
      reader.fail(key, fmt::format("{} = {} is after the end of the run, {:.6g} s; lengthen duration_s in [run] or "
                                   "leave {} out",
                                   key, *value, end_s, key));
  if (check.from_s.value_or(0.0) > check.to_s.value_or(1e6))
    reader.fail("to_s", fmt::format("to_s = {} is before from_s = {}", *check.to_s, *check.from_s));
  const auto& points = check.expected.points;
  if (!points.empty() && counted_points(check).empty())
    reader.fail(check.to_s ? "to_s" : "from_s",
                fmt::format("no expected value lies between from_s and to_s; they reach from {} to {} s",
                            points.front().time_s, points.back().time_s));
}

/// Measures that could say nothing, whatever the water does.
void refuse_idle_measures(const TableReader& reader, const Check& check, const Scene& scene) {
  const auto& expected = check.expected;
  const bool is_line = check.measure == Measure::slope || check.measure == Measure::line;
  const auto points = counted_points(check);
  const bool is_flat =
      std::all_of(points.begin(), points.end(), [&](const auto& point) { return point.value == points.front().value; });
  if (is_line && (expected.value || expected.formula == "start" || (!points.empty() && is_flat)))
    reader.fail("measure", fmt::format("measure {} needs expected values that differ from each other; these are one",
                                       to_string(check.measure)));
  if (is_line && check.relative)
    reader.fail("relative", fmt::format("relative is no part of measure {}; leave it out", to_string(check.measure)));
  const std::string unit = unit_of(scene, check.quantity), like = unit_of(scene, expected.like);
  if (!expected.like.empty() && !is_line && like != unit)
    reader.fail("like", fmt::format("{} [{}] and {} [{}] have no difference; measures slope and line compare them",
                                    check.quantity, unit, expected.like, like));
  if (check.measure == Measure::period && !expected.value && (expected.formula.empty() || expected.formula == "start"))
    reader.fail("measure", "measure period is held against value or a formula that gives a period");
  const bool any_zero = std::any_of(points.begin(), points.end(), [](const auto& point) { return point.value == 0.0; });
  if (check.relative && (expected.value == 0.0 || any_zero))
    reader.fail("relative", "relative means shares of the expected value, which is 0 here; give a scale instead");
}

void read_failures(TableReader& reader, Check& check, const Case& of) {
  const toml::node* node = reader.node("fails");
  if (node == nullptr) return;
  if (!node->is_array())
    reader.fail("fails", "fails must be an array of tables, [[check.fails]], with solver and reason");
  std::size_t index = 0;
  for (const auto& entry : *node->as_array()) {
    if (!entry.is_table()) reader.fail_at(entry, "fails must be an array of tables, [[check.fails]]");
    TableReader failure = reader.inner(*entry.as_table(), {"check.fails", ++index});
    KnownFailure known;
    std::string reason;
    failure.required("solver", known.pressure);
    failure.required("reason", known.reason);
    failure.done();
    if (known.reason.empty()) failure.fail("reason", "an expected failure needs a reason");
    if (std::count(of.solvers.begin(), of.solvers.end(), known.pressure) == 0)
      failure.fail("solver", fmt::format("{} takes no part in this case", to_string(known.pressure)));
    check.fails.push_back(known);
  }
}

}  // namespace

Check read_check(TableReader& reader, const Case& of, const CaseFiles& files) {
  Check check;
  check.source = of.source;
  reader.required("quantity", check.quantity);
  check_quantity(reader, "quantity", check.quantity, of.scene);
  check.name = check.quantity;
  reader.optional("name", check.name);
  for (const auto& other : of.checks)
    if (other.name == check.name)
      reader.fail(reader.has("name") ? "name" : "quantity",
                  "two checks are called '" + check.name + "'; give each its own name");
  reader.optional("source", check.source);
  read_expectation(reader, files, check);
  read_like(reader, check, of.scene);
  read_span(reader, check, of);
  read_measure(reader, check);
  refuse_idle_measures(reader, check, of.scene);
  read_formula(reader, check, of);
  read_failures(reader, check, of);
  return check;
}

}  // namespace squall::harness
