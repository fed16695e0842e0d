#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <ostream>

#include "harness/study/observables.h"
#include "harness/study/study_results.h"

namespace squall::harness {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string joined(const std::vector<std::string>& lines) { return fmt::format("{}", fmt::join(lines, "; ")); }

/// error, its floor
std::string error_cells(const std::map<std::string, ErrorFinding>& errors, const std::string& name) {
  const auto found = errors.find(name);
  if (found == errors.end()) return ",,";
  return "," + cell(found->second.value) + "," + (found->second.floor ? cell(*found->second.floor) : "");
}

void write_line(std::ostream& out, const StudyResult& result, std::size_t i) {
  const StudyPoint& point = result.runs.points.points[i];
  const PointFinding& finding = result.findings.points[i];
  const Scene& scene = point.run.scene;
  const Record* record = result.first_record(i);
  const bool fine = finding.status == PointStatus::fine;
  fmt::print(out, "{},{},{},{},{},{},{},{},{},{},{},{},{},{}", quoted(point.name), to_string(point.axis),
             to_string(finding.status), to_string(point.run.plan.settings.pressure), point.run.plan.backend,
             to_string(point.run.plan.settings.precision), record != nullptr ? record->threads : 0,
             record != nullptr ? record->particles : 0, scene.fluid.spacing_m, scene.fluid.support_ratio,
             scene.solver.cfl, scene.solver.dt_max_s, scene.solver.density_tolerance,
             record != nullptr ? record->steps : 0);
  fmt::print(out, ",{},{},{},{},{}", cell(finding.dt_s), fine ? cell(finding.cost) : "",
             fine ? cell(finding.frame_ms_median) : "", fine ? cell(finding.frame_ms_p95) : "",
             finding.on_front ? 1 : 0);
  for (const auto& name : error_names()) out << error_cells(finding.total_errors, name);
  for (const auto& name : error_names()) out << error_cells(finding.step_errors, name);
  fmt::print(out, ",{},{},{},{},{}\n", finding.trajectory_dx ? cell(*finding.trajectory_dx) : "",
             record != nullptr ? record->state_hash : "", quoted(result.point_commands[i].command),
             quoted(joined(point.overrides)), quoted(finding.reason));
}

}  // namespace

void write_study_csv(std::ostream& out, const StudyResult& result) {
  out << "name,axis,status,pressure,backend,precision,threads,particles,spacing_m,support_ratio,cfl,dt_max_s,"
         "density_tolerance,steps,dt_mean_s,wall_s_per_simulated_s,frame_ms_median,frame_ms_p95,pareto";
  for (const char* kind : {"total", "step"})
    for (const auto& name : error_names()) fmt::print(out, ",{0}_error_{1},{0}_noise_floor_{1}", kind, name);
  out << ",trajectory_error_dx,state_hash,command,overrides,reason\n";
  for (std::size_t i = 0; i < result.runs.points.points.size(); ++i) write_line(out, result, i);
}

}  // namespace squall::harness
