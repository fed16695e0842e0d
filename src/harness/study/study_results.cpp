#include "harness/study/study_results.h"

#include <cmath>

#include "harness/study/observables.h"

namespace squall::harness {

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json errors_json(const std::map<std::string, ErrorFinding>& errors) {
  Json json = Json::object();
  for (const auto& name : error_names())
    if (const auto found = errors.find(name); found != errors.end())
      json[name] = {{"value", number(found->second.value)},
                    {"noise_floor", number(found->second.floor)},
                    {"at_noise_floor", found->second.at_floor()}};
  return json;
}

void add_setting(const StudyRun& run, Json& json) {
  const auto& solver = run.scene.solver;
  json["pressure"] = to_string(run.plan.settings.pressure);
  json["backend"] = run.plan.backend;
  json["precision"] = to_string(run.plan.settings.precision);
  json["spacing_m"] = run.scene.fluid.spacing_m;
  json["support_ratio"] = run.scene.fluid.support_ratio;
  json["cfl"] = solver.cfl;
  json["dt_max_s"] = solver.dt_max_s;
  json["density_tolerance"] = solver.density_tolerance;
  json["divergence_tolerance"] = solver.divergence_tolerance;
}

void add_record(const Record& record, Json& json) {
  json["device"] = record.device;
  json["threads"] = record.threads;
  json["simd"] = record.simd;
  json["particles"] = record.particles;
  json["frames"] = record.frames;
  json["steps"] = record.steps;
  json["simulated_s"] = number(record.simulated_s);
  json["dt_mean_s"] = number(record.mean_dt_s());
  json["iterations_mean"] = number(record.iterations_mean);
  json["state_hash"] = record.state_hash;
}

void add_command(const StudyCommand& command, const std::vector<std::string>& overrides, Json& json) {
  json["command"] = command.command;
  json["scene_file"] = command.scene_file.empty() ? Json(nullptr) : Json(command.scene_file);
  json["overrides"] = overrides;
}

Json point_json(const StudyResult& result, std::size_t i) {
  const StudyPoint& point = result.runs.points.points[i];
  const PointFinding& finding = result.findings.points[i];
  Json json{{"name", point.name}, {"axis", to_string(point.axis)}, {"status", to_string(finding.status)}};
  if (!finding.reason.empty()) json["reason"] = finding.reason;
  json["model"] = result.runs.points.models[point.model].name;
  add_setting(point.run, json);
  if (const Record* record = result.first_record(i)) add_record(*record, json);
  if (finding.status == PointStatus::fine) {
    json["wall_s_per_simulated_s"] = number(finding.cost);
    json["wall_s_per_simulated_s_timings"] = finding.wall_s_per_s;
    json["realtime_factor"] = number(1.0 / finding.cost);
    json["frame_ms"] = {{"median", number(finding.frame_ms_median)}, {"p95", number(finding.frame_ms_p95)}};
    json["total_errors"] = errors_json(finding.total_errors);
    json["step_errors"] = errors_json(finding.step_errors);
    json["trajectory_error_dx"] = number(finding.trajectory_dx);
    json["pareto"] = finding.on_front;
  }
  add_command(result.point_commands[i], point.overrides, json);
  return json;
}

Json growth_json(const std::optional<Growth>& growth) {
  if (!growth) return nullptr;
  return {{"lyapunov_exponent_per_s", number(growth->rate_per_s)},
          {"horizon_s", number(growth->horizon_s)},
          {"horizon_reached", growth->horizon_reached},
          {"time_s", growth->time_s},
          {"median_separation_dx", growth->separation_dx}};
}

Json model_json(const StudyResult& result, std::size_t m) {
  const StudyModel& model = result.runs.points.models[m];
  const ModelRuns& runs = result.runs.models[m];
  const ModelFinding& finding = result.findings.models[m];
  Json json{{"name", model.name},
            {"pressure", to_string(model.pressure)},
            {"spacing_m", model.scene.fluid.spacing_m},
            {"support_ratio", model.scene.fluid.support_ratio}};
  json["is_yardstick"] = result.findings.yardstick == m;
  json["reference"] = nullptr;
  if (runs.reference && runs.reference_record != nullptr) {
    Json reference;
    add_setting(*runs.reference, reference);
    add_record(*runs.reference_record, reference);
    reference["frame_rate_hz"] = runs.reference->scene.time.frame_rate_hz;
    add_command(result.reference_commands[m], overrides_between(result.subjects.scene, runs.reference->scene),
                reference);
    json["reference"] = std::move(reference);
  }
  if (!runs.problem.empty()) json["problem"] = runs.problem;
  json["noise"] = nullptr;
  if (finding.noise) json["noise"] = {{"starts", finding.noise->starts}, {"spread", finding.noise->spread}};
  json["growth"] = growth_json(finding.growth);
  return json;
}

Json order_json(const OrderFinding& order) {
  Json json{{"model", order.model}, {"of", order.of}, {"error", order.error}, {"until_s", number(order.until_s)}};
  json[order.of == "step" ? "dt_s" : "spacing_m"] = order.h;
  json["differences"] = order.apart;
  json["order"] = number(order.order);
  if (!order.problem.empty()) json["problem"] = order.problem;
  return json;
}

Json name_or_null(const StudyResult& result, const std::optional<std::size_t>& point) {
  return point ? Json(result.runs.points.points[*point].name) : Json(nullptr);
}

}  // namespace

double StudyResult::simulated_s() const { return subjects.plans.front().frames / subjects.scene.time.frame_rate_hz; }

const ErrorFinding* StudyResult::ranked_error(std::size_t point) const {
  const auto& errors = findings.points[point].total_errors;
  const auto found = errors.find(question.error);
  return found == errors.end() ? nullptr : &found->second;
}

Json to_json(const StudyResult& result) {
  Json json;
  json["schema"] = k_result_schema;
  json["context"] = to_json(result.context);
  json["scene"] = {{"name", result.scene.name}, {"hash", result.scene.hash}, {"particles", result.scene.particles}};
  json["measured"] = {{"frames", result.subjects.plans.front().frames},
                      {"simulated_s", result.simulated_s()},
                      {"repeats", result.subjects.ranges.repeats},
                      {"perturbed_starts", result.subjects.ranges.perturbed},
                      {"runs_from_before", result.runs.reused}};
  json["question"] = {{"error", result.question.error},
                      {"max_error", number(result.question.max_error)},
                      {"budget_ms", number(result.question.budget_ms)}};
  json["points"] = Json::array();
  for (std::size_t i = 0; i < result.runs.points.points.size(); ++i) json["points"].push_back(point_json(result, i));
  json["models"] = Json::array();
  for (std::size_t m = 0; m < result.runs.points.models.size(); ++m) json["models"].push_back(model_json(result, m));
  json["orders"] = Json::array();
  for (const auto& order : result.findings.orders) json["orders"].push_back(order_json(order));
  json["front"] = Json::array();
  for (const auto i : result.findings.front) json["front"].push_back(result.runs.points.points[i].name);
  json["recommendation"] = {{"cheapest_within_max_error", name_or_null(result, result.findings.cheapest)},
                            {"best_within_budget", name_or_null(result, result.findings.best)},
                            {"text", recommendations(result)}};
  json["notes"] = result.notes;
  if (result.runs.interrupted) json["interrupted"] = true;
  return json;
}

}  // namespace squall::harness
