#include "harness/study/study_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/study/observables.h"

namespace squall::harness {

namespace {

std::string number(double value) { return fmt::format("{:.3g}", value); }
std::string number(const std::optional<double>& value) { return value ? number(*value) : ""; }

std::string cell(const std::map<std::string, ErrorFinding>& errors, const std::string& name) {
  const auto found = errors.find(name);
  return found == errors.end() ? "" : error_text(found->second);
}

std::string spread(const std::vector<double>& values) {
  if (values.size() < 2) return "";
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{:.3g}..{:.3g}", *low, *high);
}

std::vector<std::string> cost_row(const StudyResult& result, std::size_t i) {
  const PointFinding& point = result.findings.points[i];
  const std::string name = result.runs.points.points[i].name;
  if (point.status != PointStatus::fine)
    return {name, point.dt_s > 0.0 ? number(1e3 * point.dt_s) : "", "", "", "", "", "", to_string(point.status)};
  const ErrorFinding* error = result.ranked_error(i);
  return {name,
          number(1e3 * point.dt_s),
          number(point.cost),
          spread(point.wall_s_per_s),
          number(point.frame_ms_p95),
          error == nullptr ? "no value" : error_text(*error),
          cell(point.total_errors, "density_error_mean"),
          point.on_front ? "front" : ""};
}

std::string joined(const std::vector<std::string>& lines) { return fmt::format("{}", fmt::join(lines, "; ")); }

}  // namespace

std::string error_text(const ErrorFinding& error) {
  return error.at_floor() ? fmt::format("<= {:.2g}", *error.floor) : fmt::format("{:.3g}", error.value);
}

std::string study_headline(const StudyResult& result) {
  const auto& ranges = result.subjects.ranges;
  return fmt::format(
      "{} settings of {}, {:.4g} s of water each, timed {}; {} perturbed starts of each model in double "
      "on {}",
      result.runs.points.points.size(), result.scene.name, result.simulated_s(),
      ranges.repeats == 1 ? "once" : fmt::format("{} times", ranges.repeats), ranges.perturbed,
      result.subjects.double_plan.backend);
}

ResultTable cost_table(const StudyResult& result) {
  ResultTable table;
  table.title = fmt::format("cost and {} error", result.question.error);
  table.header = {"setting", "dt ms", "wall s/s", "timings", "p95 ms", "error", "compression", ""};
  for (std::size_t i = 0; i < result.runs.points.points.size(); ++i) table.rows.push_back(cost_row(result, i));
  return table;
}

ResultTable error_table(const StudyResult& result, bool total) {
  ResultTable table;
  table.title = total ? "total errors: against the yardstick" : "step errors: against the reference of the same model";
  table.header = {"setting"};
  for (const auto& name : error_names()) table.header.push_back(name);
  if (!total) table.header.push_back("trajectory dx");
  for (std::size_t i = 0; i < result.runs.points.points.size(); ++i) {
    const PointFinding& point = result.findings.points[i];
    if (point.status != PointStatus::fine) continue;
    std::vector<std::string> row{result.runs.points.points[i].name};
    for (const auto& name : error_names()) row.push_back(cell(total ? point.total_errors : point.step_errors, name));
    if (!total) row.push_back(number(point.trajectory_dx));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ResultTable noise_table(const StudyResult& result) {
  ResultTable table;
  table.title = "what chance makes of it: runs in double whose start differs by some 1e-6 dx";
  table.header = {"model", "exponent 1/s", "horizon s"};
  for (const auto& name : error_names()) table.header.push_back(name);
  for (std::size_t m = 0; m < result.runs.points.models.size(); ++m) {
    const ModelFinding& finding = result.findings.models[m];
    if (!finding.noise) continue;
    std::vector<std::string> row{result.runs.points.models[m].name};
    row.push_back(finding.growth ? number(finding.growth->rate_per_s) : "");
    const auto horizon = finding.growth ? finding.growth->horizon_s : std::nullopt;
    const bool reached = finding.growth && finding.growth->horizon_reached;
    row.push_back(horizon ? (reached ? "" : "> ") + number(*horizon) : "");
    for (const auto& name : error_names()) {
      const auto found = finding.noise->spread.find(name);
      row.push_back(found == finding.noise->spread.end() ? "" : fmt::format("{:.2g}", found->second));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

ResultTable order_table(const StudyResult& result) {
  ResultTable table;
  table.title = "self-convergence: order p of the differences between three steps or spacings, below the horizon";
  table.header = {"model", "of", "h1, h2, h3", "error", "until s", "|f1-f2|", "|f2-f3|", "order"};
  for (const auto& order : result.findings.orders) {
    const double unit = 1e3;  // ms or mm
    table.rows.push_back({order.model, order.of,
                          fmt::format("{:.3g}, {:.3g}, {:.3g} {}", unit * order.h[0], unit * order.h[1],
                                      unit * order.h[2], order.of == "step" ? "ms" : "mm"),
                          order.error, number(order.until_s), fmt::format("{:.2g}", order.apart[0]),
                          fmt::format("{:.2g}", order.apart[1]),
                          order.order ? fmt::format("{:.2f}", *order.order) : order.problem});
  }
  return table;
}

ResultTable command_table(const StudyResult& result) {
  ResultTable table;
  table.title = "the same runs by hand";
  table.header = {"run", "command", "differs from the scene in"};
  for (std::size_t i = 0; i < result.runs.points.points.size(); ++i)
    table.rows.push_back({result.runs.points.points[i].name, result.point_commands[i].command,
                          joined(result.runs.points.points[i].overrides)});
  for (std::size_t m = 0; m < result.runs.models.size(); ++m)
    if (const auto& reference = result.runs.models[m].reference)
      table.rows.push_back({reference->plan.label, result.reference_commands[m].command,
                            joined(overrides_between(result.subjects.scene, reference->scene))});
  return table;
}

}  // namespace squall::harness
