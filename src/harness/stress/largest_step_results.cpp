#include "harness/stress/largest_step_results.h"

#include <cmath>

namespace squall::harness {

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json result_json(const StepResult& result) {
  const StepSetting& setting = result.setting;
  const Settings& settings = setting.subject.settings;
  Json json{{"label", setting.subject.label},
            {"backend", setting.subject.backend},
            {"pressure", to_string(settings.pressure)},
            {"precision", to_string(settings.precision)},
            {"viscosity_m2_s", setting.viscosity_m2_s}};
  if (settings.pressure == Pressure::wcsph) json["speed_of_sound_m_s"] = setting.signal_m_s;
  if (settings.pressure == Pressure::mueller) json["stiffness_m2_s2"] = setting.signal_m_s * setting.signal_m_s;
  json["largest_step_s"] = result.largest_s > 0.0 ? Json(result.largest_s) : Json(nullptr);
  json["longest_tried_is_stable"] = result.at_end;
  if (!result.breaks.empty()) json["beyond_it"] = result.breaks;
  json["bounds_s"] = {{"sound", number(result.theory.sound_s)},
                      {"viscosity", number(result.theory.viscous_s)},
                      {"force", number(result.theory.force_s)},
                      {"motion", number(result.theory.motion_s)}};
  json["smallest_bound"] = result.theory.smallest_name();
  json["of_smallest_bound"] = result.of_theory();
  json["taken_step_s"] = result.taken_s;
  json["margin"] = result.margin();
  json["taken_is_stable"] = result.taken_breaks.empty();
  if (!result.taken_breaks.empty()) json["taken_breaks"] = result.taken_breaks;
  if (result.gain_anyway > 0.0) json["energy_gain_at_short_steps"] = result.gain_anyway;
  json["defect"] = result.is_defect();
  json["wall_s"] = result.wall_s;
  return json;
}

}  // namespace

Json to_json(const Context& context, bool quick, bool interrupted, const std::vector<StepResult>& results) {
  Json json;
  json["schema"] = k_result_schema;
  json["context"] = to_json(context);
  json["quick"] = quick;
  json["interrupted"] = interrupted;
  json["largest_steps"] = Json::array();
  for (const StepResult& result : results) json["largest_steps"].push_back(result_json(result));
  return json;
}

}  // namespace squall::harness
