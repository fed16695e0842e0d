#include <cmath>
#include <limits>
#include <type_traits>

#include "core/errors.h"
#include "harness/study/record.h"

namespace squall::harness {

namespace {

/// Visits every member under its name, so that writing and reading cannot differ.
template <class RecordType, class Visit>
void visit_plain(RecordType& record, Visit visit) {
  visit("key", record.key);
  visit("error", record.error);
  visit("device_failed", record.device_failed);
  visit("device", record.device);
  visit("simd", record.simd);
  visit("threads", record.threads);
  visit("state_hash", record.state_hash);
  visit("frames", record.frames);
  visit("particles", record.particles);
  visit("steps", record.steps);
  visit("simulated_s", record.simulated_s);
  visit("wall_s", record.wall_s);
  visit("frame_ms_median", record.frame_ms_median);
  visit("frame_ms_p95", record.frame_ms_p95);
  visit("smallest_dt_s", record.smallest_dt_s);
  visit("most_substeps", record.most_substeps);
  visit("iterations_mean", record.iterations_mean);
  visit("density_error_max", record.density_error_max);
  visit("energy_gain", record.energy_gain);
  visit("scales", record.scales);
  visit("time_s", record.time_s);
  visit("tracks_1e-9_dx", record.tracks);
}

double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

Json to_json(const Record& record) {
  Json json;
  visit_plain(record, [&](const char* name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      json[name] = number_or_null(value);
    else
      json[name] = value;
  });
  for (const auto& [name, values] : record.values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number_or_null(value));
    json["values"][name] = std::move(list);
  }
  return json;
}

Record record_from_json(const Json& json) {
  Record record;
  try {
    visit_plain(record, [&](const char* name, auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
        value = number_or_nan(json.at(name));
      else
        json.at(name).get_to(value);
    });
    if (json.contains("values"))
      for (const auto& [name, list] : json.at("values").items())
        for (const auto& value : list) record.values[name].push_back(number_or_nan(value));
  } catch (const Json::exception& problem) {
    throw InputError(std::string("not a run of a study: ") + problem.what());
  }
  for (const auto& [name, values] : record.values)
    if (values.size() != record.time_s.size())
      throw InputError("not a run of a study: " + name + " has not as many values as there are output times");
  return record;
}

}  // namespace squall::harness
