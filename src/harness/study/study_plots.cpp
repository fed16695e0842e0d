#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/study/observables.h"
#include "harness/study/study_report.h"

namespace squall::harness {

namespace {

constexpr const char* k_grey = "#777777";

/// A colour per pressure solver, the same in all plots.
std::string colour_of(Pressure pressure) {
  return palette_colour(pressure == Pressure::wcsph ? 0 : pressure == Pressure::dfsph ? 1 : 2);
}

/// What stands beside a point: its name without the solver, which the colour says.
std::string short_name(const std::string& name) {
  const auto comma = name.find(", ");
  return comma == std::string::npos ? std::string() : name.substr(comma + 2);
}

Series points_only(const std::string& name, const std::string& colour) {
  Series series{name, {}, colour};
  series.line = false;
  return series;
}

/// Which points have room for their name beside them: those of the front first. Places in logarithms, as they are
/// drawn.
std::vector<bool> with_names(const StudyResult& result) {
  constexpr double k_width = 0.6, k_height = 0.12;  // of a name, in factors of e^(...) at the usual ranges
  std::vector<bool> named(result.findings.points.size(), false);
  std::vector<std::pair<double, double>> taken;
  for (const bool front : {true, false})
    for (std::size_t i = 0; i < named.size(); ++i) {
      const ErrorFinding* error = result.ranked_error(i);
      const auto& point = result.findings.points[i];
      if (error == nullptr || point.on_front != front || !(error->ranked() > 0.0) || !(point.cost > 0.0)) continue;
      const double x = std::log(point.cost), y = std::log(error->ranked());
      named[i] = std::none_of(taken.begin(), taken.end(), [&](const auto& other) {
        return std::abs(other.first - x) < k_width && std::abs(other.second - y) < k_height;
      });
      if (named[i]) taken.emplace_back(x, y);
    }
  return named;
}

/// Settings of each solver as points, those of the base model's steps joined.
void add_settings(const StudyResult& result, Plot& plot) {
  const auto named = with_names(result);
  for (const Pressure pressure : result.subjects.pressures) {
    Series steps{to_string(pressure), {}, colour_of(pressure)};
    Series others = points_only("", colour_of(pressure));
    for (std::size_t i = 0; i < result.findings.points.size(); ++i) {
      const StudyPoint& point = result.runs.points.points[i];
      const ErrorFinding* error = result.ranked_error(i);
      if (error == nullptr || point.run.plan.settings.pressure != pressure) continue;
      const bool is_step = point.axis == StudyAxis::step;
      Sample sample{result.findings.points[i].cost, error->ranked(), {}, {}, named[i] ? short_name(point.name) : ""};
      (is_step ? steps : others).samples.push_back(std::move(sample));
    }
    plot.series.push_back(std::move(steps));
    plot.series.push_back(std::move(others));
  }
}

void add_front(const StudyResult& result, Plot& plot) {
  Series line{"", {}, k_grey}, rings{"", {}, k_grey};
  line.points = false;
  line.dashed = true;
  rings.line = false;
  rings.ring = true;
  for (const auto i : result.findings.front) {
    const Sample sample{result.findings.points[i].cost, result.ranked_error(i)->ranked(), {}, {}, ""};
    line.samples.push_back(sample);
    rings.samples.push_back(sample);
  }
  plot.series.push_back(std::move(line));
  plot.series.push_back(std::move(rings));
}

/// Along the upper edge, where what they cost until they failed says at least that they were tried.
void add_unstable(const StudyResult& result, Plot& plot) {
  double top = 0.0;
  for (const auto& series : plot.series)
    for (const auto& sample : series.samples) top = std::max(top, sample.y);
  Series unstable = points_only("unstable", "#b00020");
  for (std::size_t i = 0; i < result.findings.points.size(); ++i) {
    const PointFinding& point = result.findings.points[i];
    if (point.status == PointStatus::unstable && point.cost > 0.0 && top > 0.0)
      unstable.samples.push_back({point.cost, 2.0 * top, {}, {}, result.runs.points.points[i].name});
  }
  plot.series.push_back(std::move(unstable));
}

/// The lowest floor there is, where it is near enough to the points to say something.
void add_floor(const StudyResult& result, Plot& plot) {
  constexpr double k_near = 30.0;
  double lowest = k_no_end;
  for (const auto& series : plot.series)
    for (const auto& sample : series.samples) lowest = std::min(lowest, sample.y);
  std::optional<double> low;
  for (std::size_t i = 0; i < result.findings.points.size(); ++i)
    if (const ErrorFinding* error = result.ranked_error(i); error != nullptr && error->floor && *error->floor > 0.0)
      low = low ? std::min(*low, *error->floor) : *error->floor;
  if (low && k_near * *low >= lowest) plot.marks.push_back({"lowest noise floor", *low});
  if (result.question.max_error) plot.marks.push_back({"largest error asked for", *result.question.max_error});
}

Plot work_precision(const StudyResult& result) {
  Plot plot;
  plot.name = "work_precision";
  plot.title = fmt::format("{}: {} error against cost", result.scene.name, result.question.error);
  plot.x = {"wall seconds per simulated second", true};
  plot.y = {fmt::format("{} error against the yardstick", result.question.error), true};
  add_settings(result, plot);
  add_front(result, plot);
  add_unstable(result, plot);
  add_floor(result, plot);
  return plot;
}

/// Of every base model and observable: how the error falls with the step.
Plot step_errors(const StudyResult& result) {
  Plot plot;
  plot.name = "step_error";
  plot.title = result.scene.name + ": error of the step against the step";
  plot.x = {"mean sub-step [ms]", true};
  plot.y = {fmt::format("{} error against 1/8 of the finest step", result.question.error), true};
  for (std::size_t m = 0; m < result.runs.points.models.size(); ++m) {
    const StudyModel& model = result.runs.points.models[m];
    if (!model.is_base) continue;
    Series series{model.name, {}, colour_of(model.pressure)};
    std::optional<double> floor;
    for (std::size_t i = 0; i < result.findings.points.size(); ++i) {
      const StudyPoint& point = result.runs.points.points[i];
      const auto& errors = result.findings.points[i].step_errors;
      const auto error = errors.find(result.question.error);
      if (point.model != m || point.axis != StudyAxis::step || error == errors.end()) continue;
      series.samples.push_back({1e3 * result.findings.points[i].dt_s, error->second.value, {}, {}, ""});
      floor = error->second.floor;
    }
    plot.series.push_back(std::move(series));
    if (floor && *floor > 0.0) plot.marks.push_back({"noise floor of " + model.name, *floor});
  }
  return plot;
}

Plot separations(const StudyResult& result) {
  Plot plot;
  plot.name = "separation";
  plot.title = result.scene.name + ": two starts that differ by some 1e-6 dx";
  plot.x = {"time [s]"};
  plot.y = {"median distance of a particle from itself [dx]", true};
  for (std::size_t m = 0; m < result.runs.points.models.size(); ++m) {
    const auto& growth = result.findings.models[m].growth;
    const StudyModel& model = result.runs.points.models[m];
    if (!growth || !model.is_base) continue;
    Series series{model.name, {}, colour_of(model.pressure)};
    for (std::size_t i = 0; i < growth->time_s.size(); ++i)
      series.samples.push_back({growth->time_s[i], growth->separation_dx[i], {}, {}, ""});
    plot.series.push_back(std::move(series));
  }
  plot.marks.push_back({"horizon: 0.1 dx", k_horizon_dx});
  return plot;
}

}  // namespace

std::vector<Plot> study_plots(const StudyResult& result) {
  return {work_precision(result), step_errors(result), separations(result)};
}

}  // namespace squall::harness
