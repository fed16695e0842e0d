#include "harness/validation/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "core/text_file.h"
#include "harness/gauges.h"
#include "harness/validation/observer.h"

namespace squall::harness {

namespace {

constexpr int k_most_samples = 64;
constexpr double k_most_samples_hz = 1000.0;  ///< frames of a scene may be no shorter
constexpr int k_samples_for_pressure = 8;

}  // namespace

const char* to_string(Measure measure) {
  switch (measure) {
    case Measure::max:
      return "max";
    case Measure::rms:
      return "rms";
    case Measure::mean:
      return "mean";
    case Measure::slope:
      return "slope";
    case Measure::line:
      return "line";
    case Measure::period:
      return "period";
    case Measure::below:
      return "below";
    case Measure::above:
      return "above";
  }
  return "";
}

double duration_of(const Case& of) {
  constexpr double k_rounding = 1e-9;
  const double rate_hz = of.scene.time.frame_rate_hz * of.samples_per_frame;
  return std::max(1.0, std::ceil(of.duration_s * rate_hz - k_rounding)) / rate_hz;
}

int most_samples(const Scene& scene) {
  return std::clamp(static_cast<int>(k_most_samples_hz / scene.time.frame_rate_hz), 1, k_most_samples);
}

void set_defaults(Case& result) {
  const Scene& scene = result.scene;
  result.duration_s = scene.time.duration_s;
  const bool has_pressure = Gauges(scene, Pressure::wcsph).has_pressure();
  result.samples_per_frame = has_pressure ? std::min(most_samples(scene), k_samples_for_pressure) : 1;
  result.solvers = {Pressure::dfsph, Pressure::wcsph, Pressure::mueller};
  if (scene.solver.xsph > 0.0) result.solvers = {Pressure::dfsph};
  if (scene.solver.pressure) result.solvers = {*scene.solver.pressure};
  std::erase_if(result.solvers, [&](Pressure pressure) { return !ratio_problem(scene, pressure).empty(); });
}

Case case_from_table(const std::string& scene_path, const std::string& table_path, double tolerance) {
  Case result;
  result.scene = load_scene(scene_path);
  result.name = result.scene.name;
  result.title = "scene " + result.name + " against a table";
  result.source = table_path;
  result.files = {scene_path, table_path};
  for (const auto& file : result.scene.particle_files)
    result.files.push_back((std::filesystem::path(scene_path).parent_path() / file.file).string());
  set_defaults(result);
  const auto names = quantity_names(result.scene);
  double latest = 1.0 / result.scene.time.frame_rate_hz;
  for (const auto& [name, points] : parse_expected_csv(read_text_file(table_path), table_path)) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(fmt::format("{}: column '{}' is neither a gauge of {} nor a quantity; did you mean '{}'?",
                                   table_path, name, scene_path, nearest_name(name, names)));
    Check check;
    check.name = check.quantity = name;
    check.source = table_path;
    check.expected.points = points;
    check.measure = Measure::rms;
    if (points.front().time_s < 0.0)
      throw InputError(fmt::format("{}: time_s = {} is before the start of the run; times begin at 0", table_path,
                                   points.front().time_s));
    double largest = 0.0;
    for (const auto& point : points) {
      largest = std::max(largest, std::abs(point.value));
      latest = std::max(latest, point.time_s);
    }
    if (!(largest > 0.0))
      throw InputError(
          fmt::format("{}: column '{}' is 0 throughout, and a share of that no tolerance; write a case with a "
                      "tolerance in its unit (docs/validation.md)",
                      table_path, name));
    check.scale = largest;
    check.tolerance = tolerance;
    check.tolerance_why = "as given, of the column's largest value";
    result.checks.push_back(std::move(check));
  }
  result.duration_s = latest;
  return result;
}

Case load_case(const std::string& path) {
  std::vector<std::string> files;
  const FileReader read = [&](const std::string& file) {
    files.push_back(file);
    return read_text_file(file);
  };
  Case result = parse_case(read(path), path, read);
  result.files = std::move(files);
  return result;
}

}  // namespace squall::harness
