#include "harness/results_json.h"

#include <cmath>

#include "core/state_hash.h"

namespace squall::harness {

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json tail(const Tail& value) {
  return {{"median", number(value.median)},
          {"p95", number(value.p95)},
          {"p99", number(value.p99)},
          {"max", number(value.max)}};
}

bool has_numbers(const Row& row) { return row.error.empty() && row.frames > 0; }

Json identity(const Row& row) {
  return {{"label", row.plan.label},
          {"backend", row.plan.backend},
          {"device", row.solver.device},
          {"threads", row.solver.threads},
          {"simd", row.solver.simd},
          {"precision", to_string(row.plan.settings.precision)},
          {"pressure", to_string(row.plan.settings.pressure)},
          {"particles", row.particles},
          {"frames", row.frames}};
}

void add_times(const Row& row, Json& json) {
  json["steps"] = row.steps;
  json["simulated_s"] = number(row.simulated_s);
  json["wall_s"] = number(row.wall_s);
  json["realtime_factor"] = number(row.realtime_factor);
  json["fps"] = number(row.fps);
  json["setup_ms"] = number(row.solver.setup_ms);
  json["frame_ms"] = tail(row.frame_ms);
  json["compute_ms"] = tail(row.compute_ms);
  json["readback_ms"] = tail(row.readback_ms);
  json["upload_ms"] = tail(row.upload_ms);
  json["readback_mode"] = readback_name(row);
  json["readback_bytes_per_frame"] = number(row.readback_bytes_per_frame);
  json["readback_copied_bytes_per_frame"] = number(row.readback_copied_bytes_per_frame);
  json["readback_latency_frames"] = row.readback_latency_frames;
  if (row.readback_copy_ms) json["readback_copy_ms"] = number(row.readback_copy_ms);
  if (row.readback_overlap) json["readback_overlap"] = number(row.readback_overlap);
  json["readback_share"] = number(row.readback_share);
  if (row.exposed_readback_ms) json["exposed_readback_ms"] = number(row.exposed_readback_ms);
  if (const auto& interval = row.exposed_readback_interval_ms)
    json["exposed_readback_interval_ms"] = {
        {"low", number(interval->low)}, {"high", number(interval->high)}, {"confidence", number(interval->confidence)}};
  json["phase_ms"] = Json::object();
  for (const auto& [phase, ms] : row.phase_ms) json["phase_ms"][phase] = number(ms);
  json["particle_steps_per_s"] = number(row.particle_steps_per_s);
  json["pairs_per_s"] = number(row.pairs_per_s);
}

/// Of dfsph alone.
void add_iterations(const Row& row, Json& json) {
  json["density_iterations"] = {{"mean", number(row.density_iterations_mean)}, {"max", row.density_iterations_max}};
  json["divergence_iterations"] = {{"mean", number(row.divergence_iterations_mean)},
                                   {"max", row.divergence_iterations_max}};
  json["unconverged"] = row.unconverged;
  json["light_passes_mean"] = number(row.light_passes_mean);
  json["light_pass_ns"] = row.light_pass_ns ? number(*row.light_pass_ns) : Json(nullptr);
}

void add_water(const Row& row, Json& json) {
  json["neighbours_mean"] = number(row.neighbours_mean);
  json["iterations_mean"] = number(row.iterations_mean);
  if (row.plan.settings.pressure == Pressure::dfsph) add_iterations(row, json);
  json["density_error_mean"] = number(row.density_error_mean);
  json["density_error_max"] = number(row.density_error_max);
  json["density_error_worst"] = number(row.density_error_worst);
  json["energy_drift"] = number(row.energy_drift);
  if (row.position_error_dx) json["position_error_dx"] = number(row.position_error_dx);
}

}  // namespace

std::string readback_name(const Row& row) {
  if (row.plan.settings.readback == Readback::none) return "none";
  return row.plan.backend == "opencl" ? to_string(row.plan.settings.readback) : "in_place";
}

Json to_json(const DeviceInfo& device) {
  return {{"index", device.index},
          {"name", device.name},
          {"platform", device.platform},
          {"driver", device.driver},
          {"version", device.version},
          {"kind", device.kind},
          {"compute_units", device.compute_units},
          {"double_precision", device.has_double},
          {"bitwise", device.bitwise},
          {"lacks", device.lacks},
          {"problem", device.problem}};
}

Json to_json(const Row& row) {
  Json json = identity(row);
  if (const WorkSizes& work = row.plan.settings.work; row.plan.backend == "opencl")
    json["work_sizes"] = {{"group", work.group}, {"parts", work.parts}, {"chunks", work.chunks}};
  if (has_numbers(row)) {
    add_times(row, json);
    add_water(row, json);
  }
  if (!row.error.empty()) json["error"] = row.error;
  if (row.interrupted) json["interrupted"] = true;
  if (row.plan.settings.trace) json["traced"] = true;
  if (row.start_frame > 0) json["start_frame"] = row.start_frame;
  json["clamps"] = row.clamps;
  json["lost_particles"] = row.lost_particles;
  json["state_hash"] = hash_text(row.state_hash);
  return json;
}

Json to_json(const std::optional<Agreement>& agreement) {
  if (!agreement) return nullptr;
  Json json;
  json["bitwise"] = agreement->bitwise ? Json(*agreement->bitwise) : Json(nullptr);
  json["first_difference_frame"] =
      agreement->first_difference_frame ? Json(*agreement->first_difference_frame) : Json(nullptr);
  const auto& difference = agreement->difference;
  json["first_difference_particle"] = difference ? Json(difference->particle) : Json(nullptr);
  const bool compared = agreement->bitwise.has_value();
  json["max_position_error_dx"] = difference ? number(difference->max_position_error_dx)
                                  : compared ? Json(0.0)
                                             : Json(nullptr);
  json["max_velocity_error"] = difference ? number(difference->max_velocity_error)
                               : compared ? Json(0.0)
                                          : Json(nullptr);
  json["verdict"] = agreement->verdict;
  return json;
}

Json to_json(const Context& context) {
  Json json{{"squall_version", context.squall_version},
            {"git_revision", context.git_revision},
            {"date", context.date},
            {"host", context.host},
            {"cpu", context.cpu},
            {"cores", context.cores},
            {"threads", context.threads},
            {"compiler", context.compiler},
            {"flags", context.flags}};
  json["opencl"] = nullptr;
  if (const auto& device = context.opencl)
    json["opencl"] = {{"platform", device->platform},
                      {"device", device->name},
                      {"driver", device->driver},
                      {"version", device->version},
                      {"build_options", context.opencl_build_options}};
  return json;
}

Json to_json(const Context& context, const SceneInfo& scene, const std::vector<Row>& rows,
             const std::optional<Agreement>& agreement) {
  Json json;
  json["schema"] = k_result_schema;
  json["context"] = to_json(context);
  json["scene"] = {{"name", scene.name}, {"hash", scene.hash}, {"particles", scene.particles}};
  json["runs"] = Json::array();
  for (const auto& row : rows) json["runs"].push_back(to_json(row));
  json["agreement"] = to_json(agreement);
  return json;
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json to_google_benchmark(const Context& context, const SceneInfo& scene, const std::vector<Row>& rows) {
  Json json;
  json["context"] = {{"date", context.date},
                     {"host_name", context.host},
                     {"executable", "squall"},
                     {"num_cpus", context.threads},
                     {"library_build_type", "release"},
                     {"squall_version", context.squall_version},
                     {"git_revision", context.git_revision}};
  json["benchmarks"] = Json::array();
  for (const auto& row : rows) {
    const std::string name = scene.name + "/" + row.plan.label;
    Json entry{{"name", name},     {"run_name", name},      {"run_type", "iteration"},
               {"repetitions", 1}, {"repetition_index", 0}, {"threads", row.solver.threads}};
    entry["iterations"] = row.frames;
    entry["real_time"] = number(has_numbers(row) ? row.frame_ms.median : 0.0);
    entry["cpu_time"] = number(has_numbers(row) ? row.cpu_ms_mean : 0.0);
    entry["time_unit"] = "ms";
    if (!has_numbers(row)) {
      entry["error_occurred"] = true;
      entry["error_message"] = row.error.empty() ? "ended before the first counted frame" : row.error;
    }
    json["benchmarks"].push_back(entry);
  }
  return json;
}

}  // namespace squall::harness
