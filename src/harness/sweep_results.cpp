#include "harness/sweep_results.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <ostream>

#include "core/state_hash.h"

namespace squall::harness {

namespace {

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json interval_json(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  return {{"low", interval->low}, {"high", interval->high}, {"confidence", interval->confidence}};
}

void add_size(const SizeInfo& size, Json& json) {
  json["scene_particles"] = size.scene_particles;
  json["spacing_m"] = size.spacing_m;
  json["scene_hash"] = size.scene_hash;
}

Json point_json(const SweepPoint& point) {
  Json json = to_json(point.row);
  add_size(point.size, json);
  json["speedup"] = or_null(point.speedup);
  return json;
}

Json size_json(const SweepSize& size) {
  Json json{{"particles", size.particles}};
  add_size(size.size, json);
  json["agreement"] = to_json(std::optional(size.agreement));
  return json;
}

Json lead_json(const Lead& lead) {
  return {{"particles", lead.particles},
          {"against", lead.against},
          {"ratio", lead.ratio},
          {"ratio_interval", interval_json(lead.interval)}};
}

Json crossover_json(const Crossover& crossover) {
  Json json{{"label", crossover.label}, {"against", crossover.against}};
  json["crossings"] = Json::array();
  for (const auto& crossing : crossover.crossings)
    json["crossings"].push_back({{"particles", crossing.particles},
                                 {"overtakes", crossing.overtakes},
                                 {"between", {crossing.between_low, crossing.between_high}},
                                 {"sure", crossing.sure}});
  json["leads"] = Json::array();
  for (const auto& lead : crossover.leads) json["leads"].push_back(lead_json(lead));
  json["verdict"] = crossover.verdict;
  return json;
}

const char* fit_name(BudgetFit fit) {
  switch (fit) {
    case BudgetFit::none:
      return "none";
    case BudgetFit::within:
      return "within";
    case BudgetFit::all:
      return "all";
    case BudgetFit::not_measured:
      break;
  }
  return "not_measured";
}

Json budget_json(const SweepResult& result) {
  if (!result.plan.budget_ms) return nullptr;
  Json json{{"budget_ms", *result.plan.budget_ms}};
  json["runs"] = Json::array();
  for (const auto& entry : result.sweep.budget) {
    Json run{{"label", entry.label}, {"fit", fit_name(entry.fit)}};
    run["estimate_particles"] = or_null(entry.estimate_particles);
    run["largest"] = entry.largest ? point_json(*entry.largest) : Json(nullptr);
    run["tried"] = Json::array();
    for (const auto& point : entry.tried) run["tried"].push_back(point_json(point));
    run["verdict"] = entry.verdict;
    json["runs"].push_back(run);
  }
  return json;
}

/// A field of a CSV file (RFC 4180): in quotes, quotes inside doubled.
std::string csv_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return result + "\"";
}

}  // namespace

Json to_json(const SweepResult& result) {
  Json json;
  const RunPlan& run = result.plan.runs.front();
  json["schema"] = k_result_schema;
  json["context"] = to_json(result.context);
  json["scene"] = {{"name", result.scene.name}, {"hash", result.scene.hash}, {"particles", result.scene.particles}};
  json["measured"] = {{"warm_up_frames", run.warm_up_frames},
                      {"frames", run.frames},
                      {"from_s", run.warm_up_frames / result.frame_rate_hz},
                      {"to_s", (run.warm_up_frames + run.frames) / result.frame_rate_hz}};
  json["points"] = Json::array();
  for (const auto& point : result.sweep.points) json["points"].push_back(point_json(point));
  json["sizes"] = Json::array();
  for (const auto& size : result.sweep.sizes) json["sizes"].push_back(size_json(size));
  json["crossover"] = Json::array();
  for (const auto& crossover : result.sweep.crossovers) json["crossover"].push_back(crossover_json(crossover));
  json["budget"] = budget_json(result);
  json["agreement"] = to_json(std::optional(overall_agreement(result.sweep)));
  json["notes"] = result.sweep.notes;
  if (result.sweep.interrupted) json["interrupted"] = true;
  return json;
}

void write_points_header(std::ostream& out) {
  out << "run,backend,device,threads,simd,precision,pressure,scene_particles,particles,spacing_m,frames,steps,"
         "simulated_s,wall_s,realtime_factor,fps,speedup,frame_ms_median,frame_ms_p95,frame_ms_p99,frame_ms_max,"
         "compute_ms_median,readback_ms_median,upload_ms_median,readback_mode,readback_bytes_per_frame,readback_share,"
         "particle_steps_per_s,pairs_per_s,neighbours_mean,density_error_mean,density_error_max,clamps,lost_particles,"
         "state_hash,interrupted,error\n";
}

void write_point(std::ostream& out, const SweepPoint& point) {
  const Row& r = point.row;
  // Numbers of a row with an error mean nothing: their fields stay empty, as the JSON leaves them out.
  const bool has_numbers = r.error.empty() && r.frames > 0;
  const auto number = [&](double value) {
    return has_numbers && std::isfinite(value) ? fmt::format("{}", value) : std::string();
  };
  fmt::print(out, "{},{},{},{},{},{},{},{},{},{},{},{},", csv_text(r.plan.label), r.plan.backend,
             csv_text(r.solver.device), r.solver.threads, r.solver.simd, to_string(r.plan.settings.precision),
             to_string(r.plan.settings.pressure), point.size.scene_particles, r.particles, point.size.spacing_m,
             r.frames, r.steps);
  for (const double value : {r.simulated_s, r.wall_s, r.realtime_factor, r.fps}) fmt::print(out, "{},", number(value));
  fmt::print(out, "{},", point.speedup ? number(*point.speedup) : "");
  for (const double value : {r.frame_ms.median, r.frame_ms.p95, r.frame_ms.p99, r.frame_ms.max, r.compute_ms.median,
                             r.readback_ms.median, r.upload_ms.median})
    fmt::print(out, "{},", number(value));
  fmt::print(out, "{},", readback_name(r));
  for (const double value : {r.readback_bytes_per_frame, r.readback_share, r.particle_steps_per_s, r.pairs_per_s,
                             r.neighbours_mean, r.density_error_mean, r.density_error_max})
    fmt::print(out, "{},", number(value));
  fmt::print(out, "{},{},{},{},{}\n", r.clamps, r.lost_particles, hash_text(r.state_hash), r.interrupted ? 1 : 0,
             r.error.empty() ? "" : csv_text(r.error));
}

std::string measured_part(const SweepResult& result) {
  const RunPlan& run = result.plan.runs.front();
  return fmt::format(
      "{} frames of 1/{:.4g} s after {} uncounted ones, at every size: {:.3f} s to {:.3f} s of the scene", run.frames,
      result.frame_rate_hz, run.warm_up_frames, run.warm_up_frames / result.frame_rate_hz,
      (run.warm_up_frames + run.frames) / result.frame_rate_hz);
}

}  // namespace squall::harness
