#include "harness/validation/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/state_hash.h"

namespace squall::harness {

namespace {

constexpr std::size_t k_most_points = 400;  ///< of a check in the JSON; series.csv has all of them

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json point_json(const ComparedPoint& point) {
  return {{"time_s", number(point.time_s)}, {"measured", number(point.measured)}, {"expected", number(point.expected)}};
}

Json points_json(const std::vector<ComparedPoint>& points) {
  Json json = Json::array();
  const std::size_t stride = 1 + (points.empty() ? 0 : (points.size() - 1) / k_most_points);
  for (std::size_t i = 0; i < points.size(); i += stride) json.push_back(point_json(points[i]));
  return json;
}

Json verdict_json(const Verdict& verdict, const CaseRun& run) {
  const Finding& finding = verdict.finding;
  Json json{{"pressure", to_string(run.plan.settings.pressure)},
            {"backend", run.plan.backend},
            {"verdict", finding.passed ? "pass" : "fail"},
            {"expected_verdict", verdict.expected_to_pass ? "pass" : "fail"},
            {"as_expected", verdict.as_expected()},
            {"error", number(finding.error)},
            {"tolerance", number(finding.tolerance)},
            {"furthest", finding.points.empty() ? Json(nullptr) : point_json(finding.worst)},
            {"points", points_json(finding.points)}};
  if (finding.shift_s) json["time_shift_s"] = *finding.shift_s;
  if (!verdict.reason.empty()) json["reason"] = verdict.reason;
  if (!finding.problem.empty()) json["problem"] = finding.problem;
  if (run.interrupted) json["interrupted"] = true;
  return json;
}

Json check_json(const CaseResult& result, std::size_t index) {
  const Check& check = result.what.checks[index];
  const std::string unit = unit_of(result, check.quantity);
  Json json{{"name", check.name},
            {"quantity", check.quantity},
            {"unit", unit},
            {"measure", to_string(check.measure)},
            {"error_unit", error_unit(check, unit)},
            {"tolerance_why", check.tolerance_why},
            {"source", check.source},
            {"results", Json::array()}};
  for (const auto& run : result.runs) json["results"].push_back(verdict_json(run.verdicts[index], run));
  return json;
}

Json run_json(const CaseRun& run) {
  Json json{{"pressure", to_string(run.plan.settings.pressure)},
            {"backend", run.plan.backend},
            {"device", run.solver.device},
            {"threads", run.solver.threads},
            {"precision", to_string(run.plan.settings.precision)},
            {"particles", run.particles},
            {"spacing_m", run.scene.fluid.spacing_m},
            {"scene_hash", scene_hash(run.scene)},
            {"simulated_s", run.simulated_s},
            {"steps", run.steps},
            {"iterations_mean", run.iterations_mean},
            {"clamps", run.clamps},
            {"wall_s", run.wall_s}};
  if (run.plan.settings.pressure == Pressure::dfsph) json["unconverged"] = run.unconverged;
  if (!run.warnings.empty()) json["warnings"] = run.warnings;
  if (!run.error.empty()) json["error"] = run.error;
  if (run.interrupted) json["interrupted"] = true;
  return json;
}

}  // namespace

Json to_json(const Context& context, const std::vector<CaseResult>& results, const std::vector<std::string>& notes) {
  Json json{{"schema", k_result_schema}, {"context", to_json(context)}, {"cases", Json::array()}};
  bool interrupted = false;
  for (const auto& result : results) {
    Json entry{{"name", result.what.name},
               {"title", result.what.title},
               {"source", result.what.source},
               {"scene", result.what.scene.name},
               {"scene_hash", scene_hash(result.what.scene)},
               {"checks", Json::array()},
               {"runs", Json::array()}};
    for (std::size_t i = 0; i < result.what.checks.size(); ++i) entry["checks"].push_back(check_json(result, i));
    for (const auto& run : result.runs) {
      entry["runs"].push_back(run_json(run));
      interrupted = interrupted || run.interrupted;
    }
    json["cases"].push_back(std::move(entry));
  }
  json["as_expected"] = all_as_expected(results);
  json["notes"] = notes;
  if (interrupted) json["interrupted"] = true;
  return json;
}

std::string short_number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : ""; }

std::string unit_of(const CaseResult& result, const std::string& quantity) {
  for (const auto& run : result.runs)
    if (const Column* column = run.series.find(quantity)) return column->unit;
  return "";
}

std::string run_name(const CaseRun& run) {
  return fmt::format("{} on {}", to_string(run.plan.settings.pressure), run.plan.label);
}

std::string verdict_text(const Verdict& verdict) {
  if (verdict.finding.passed) return verdict.expected_to_pass ? "pass" : "PASSES, unexpected";
  return verdict.as_expected() ? "fails, as expected" : "FAILS";
}

std::string measure_text(const Check& check) {
  const std::string of = check.relative ? ", relative" : check.scale ? fmt::format(" / {:.4g}", *check.scale) : "";
  switch (check.measure) {
    case Measure::max:
      return "largest difference" + of;
    case Measure::rms:
      return "rms difference" + of;
    case Measure::mean:
      return "mean difference" + of;
    case Measure::slope:
      return "slope of measured against expected, less 1";
    case Measure::line:
      return "largest distance from a straight line" + of;
    case Measure::period:
      return "difference of the period" + of;
    case Measure::below:
      return "largest excess above the bound" + of;
    case Measure::above:
      return "largest lack below the bound" + of;
  }
  return "";
}

namespace {

constexpr const char* k_no_value_text = "no value";

std::string measured_text(double value) { return std::isfinite(value) ? short_number(value) : k_no_value_text; }

}  // namespace

VerdictTable verdict_table(const CaseResult& result) {
  VerdictTable table;
  table.header = {"check", "solver", "particles", "at s", "measured", "expected",
                  "unit",  "error",  "tolerance", "of",   "shift s",  "verdict"};
  for (std::size_t c = 0; c < result.what.checks.size(); ++c) {
    const Check& check = result.what.checks[c];
    const std::string unit = unit_of(result, check.quantity);
    for (const auto& run : result.runs) {
      const Verdict& verdict = run.verdicts[c];
      const Finding& found = verdict.finding;
      const bool seen = !found.points.empty();
      const bool slope = check.measure == Measure::slope, period = check.measure == Measure::period;
      table.rows.push_back({check.name, run_name(run), fmt::format("{}", run.particles),
                            seen && !slope && !period ? short_number(found.worst.time_s) : "",
                            seen ? measured_text(found.worst.measured) : k_no_value_text,
                            seen ? short_number(found.worst.expected) : "",
                            slope    ? "1"
                            : period ? "s"
                                     : unit,
                            short_number(found.error), short_number(found.tolerance), error_unit(check, unit),
                            found.shift_s ? fmt::format("{:+.4f}", *found.shift_s) : "",
                            run.interrupted ? "interrupted" : verdict_text(verdict)});
    }
  }
  return table;
}

std::vector<std::string> remarks(const CaseResult& result) {
  std::vector<std::string> all;
  for (std::size_t c = 0; c < result.what.checks.size(); ++c)
    for (const auto& run : result.runs) {
      const Verdict& verdict = run.verdicts[c];
      if (run.interrupted) continue;
      const std::string what = fmt::format("{}, {}", result.what.checks[c].name, run_name(run));
      const std::string& problem = verdict.finding.problem;
      if (!verdict.expected_to_pass && !verdict.finding.lacks_values)
        all.push_back(fmt::format("{}: {}: {}{}", what, verdict_text(verdict), verdict.reason,
                                  problem.empty() ? "" : " (" + problem + ")"));
      else if (!verdict.finding.passed)
        all.push_back(fmt::format("{}: FAILS{}", what, problem.empty() ? "" : ": " + problem));
    }
  for (const auto& run : result.runs)
    for (const auto& warning : run.warnings) all.push_back(fmt::format("{}: {}", run_name(run), warning));
  return all;
}

}  // namespace squall::harness
