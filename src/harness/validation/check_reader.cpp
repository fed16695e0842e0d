#include "harness/validation/check_reader.h"

#include <algorithm>

#include "core/errors.h"
#include "core/nearest_name.h"
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
  std::stable_sort(check.expected.points.begin(), check.expected.points.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
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
void read_formula(TableReader& reader, Check& check, const Scene& scene) {
  const toml::node* node = reader.node("parameters");
  if (node != nullptr) {
    if (check.expected.formula.empty() || !node->is_table())
      reader.fail("parameters", "parameters is a table of numbers that belongs to formula");
    for (const auto& [key, entry] : *node->as_table()) {
      const auto number = number_of(entry);
      if (!number) reader.fail_at(entry, fmt::format("parameter {} must be a finite number", key.str()));
      check.expected.parameters[std::string(key.str())] = *number;
    }
  }
  if (!check.expected.like.empty()) check_quantity(reader, "like", check.expected.like, scene);
  if (check.expected.formula.empty() || check.expected.formula == "start") return;
  try {
    make_curve(check.expected.formula, {scene, check.quantity, check.expected.parameters});
  } catch (const InputError& error) {
    reader.fail("formula", error.what());
  }
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
  reader.number("from_s", check.from_s, 0.0, 1e6);
  reader.number("to_s", check.to_s, 0.0, 1e6);
  reader.number("largest_shift_s", check.largest_shift_s, 0.0, 1e6);
  if (check.from_s.value_or(0.0) > check.to_s.value_or(1e6))
    reader.fail("to_s", fmt::format("to_s = {} is before from_s = {}", *check.to_s, *check.from_s));
  read_measure(reader, check);
  read_formula(reader, check, of.scene);
  read_failures(reader, check, of);
  return check;
}

}  // namespace squall::harness
