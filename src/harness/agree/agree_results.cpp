#include "harness/agree/agree_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/state_hash.h"

namespace squall::harness {

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ulps_json(const Ulps& ulps) { return {{"max", number(ulps.max)}, {"rms", number(ulps.rms)}}; }

Json steps_json(const std::vector<StepCheck>& steps) {
  Json json = Json::array();
  for (const StepCheck& step : steps)
    json.push_back({{"start", step.start},
                    {"same_order", step.integers.same_order},
                    {"neighbour_counts_differ", step.integers.neighbours_differ},
                    {"same_counts", step.integers.same_counts},
                    {"density_ulp", ulps_json(step.errors.density)},
                    {"pressure_ulp", ulps_json(step.errors.pressure)},
                    {"force_ulp", ulps_json(step.errors.force)},
                    {"neighbour_counts_unlike_double", step.errors.neighbours_differ}});
  return json;
}

Json growth_json(const std::vector<Distance>& growth) {
  Json max = Json::array(), rms = Json::array();
  for (const Distance& distance : growth) {
    max.push_back(number(distance.max_dx));
    rms.push_back(number(distance.rms_dx));
  }
  return {{"max_dx", max}, {"rms_dx", rms}};
}

Json observed_json(const std::vector<ObservedDistance>& observed) {
  Json json = Json::object();
  for (const auto& one : observed)
    json[one.what] = {{"distance", number(one.distance)}, {"noise_floor", number(one.floor)}, {"within", one.within()}};
  return json;
}

Json subject_json(const SubjectResult& subject) {
  const RunPlan& plan = subject.subject.plan;
  Json json{{"label", plan.label},
            {"backend", plan.backend},
            {"device", subject.solver.device},
            {"threads", subject.solver.threads},
            {"simd", subject.solver.simd},
            {"precision", to_string(plan.settings.precision)},
            {"pressure", to_string(plan.settings.pressure)},
            {"promises_bits", plan.strict},
            {"lacks", subject.subject.lacks},
            {"frames", subject.hashes.size()},
            {"steps", subject.substeps},
            {"integers", to_string(subject.integers)},
            {"one_step", to_string(subject.one_step)},
            {"bits", to_string(subject.bits)},
            {"long_run", to_string(subject.long_run)},
            {"run_to_run", to_string(subject.again)},
            {"restart", to_string(subject.restart)},
            {"hand_over", to_string(subject.hand_over)},
            {"agrees", subject.agrees()},
            {"build_options", subject.solver.build_options}};
  if (!subject.error.empty()) json["error"] = subject.error;
  json["notes"] = subject.notes;
  json["single_steps"] = steps_json(subject.steps);
  if (!subject.growth.empty()) json["growth"] = growth_json(subject.growth);
  if (!subject.observed.empty()) json["observables"] = observed_json(subject.observed);
  return json;
}

Json pair_json(const PairResult& pair, const std::vector<SubjectResult>& subjects) {
  Json json{{"first", subjects[pair.first].subject.plan.label},
            {"second", subjects[pair.second].subject.plan.label},
            {"bits_promised", pair.promised},
            {"bitwise", pair.bitwise}};
  json["first_difference_frame"] = pair.frame ? Json(*pair.frame) : Json(nullptr);
  if (!pair.difference) return json;
  const FirstDifference& difference = *pair.difference;
  json["found_again"] = difference.found_again;
  if (!difference.found_again) return json;
  json["first_difference_substep"] = difference.substep;
  json["first_difference_particle"] = difference.state.particle;
  json["what"] = difference.state.what;
  json["particles"] = difference.state.particles;
  json["max_position_error_dx"] = number(difference.state.max_position_dx);
  json["max_velocity_error"] = number(difference.state.max_velocity);
  return json;
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::same:
      return "same";
    case Verdict::within:
      return "within";
    case Verdict::differs:
      return "differs";
    case Verdict::not_tried:
      break;
  }
  return "not tried";
}

Json to_json(const Context& context, const SceneInfo& scene, const AgreeResult& result) {
  Json json;
  json["schema"] = k_result_schema;
  json["context"] = to_json(context);
  json["scene"] = {{"name", scene.name}, {"hash", scene.hash}, {"particles", scene.particles}};
  json["settings"] = {{"frames", result.settings.frames},
                      {"horizon_frames", result.settings.horizon},
                      {"perturbed_runs", result.settings.members}};
  json["runs"] = Json::array();
  for (const auto& subject : result.subjects) json["runs"].push_back(subject_json(subject));
  json["pairs"] = Json::array();
  for (const auto& pair : result.pairs) json["pairs"].push_back(pair_json(pair, result.subjects));
  json["double_precision"] = {{"growth", growth_json(result.double_growth)},
                              {"observables", observed_json(result.double_observed)}};
  if (result.interrupted) json["interrupted"] = true;
  const auto bitwise = std::count_if(result.pairs.begin(), result.pairs.end(), [](const auto& p) { return p.bitwise; });
  json["agreement"] = {{"agree", result.interrupted ? Json(nullptr) : Json(result.agree())},
                       {"pairs", result.pairs.size()},
                       {"bitwise_pairs", bitwise},
                       {"verdict", verdict_text(result)}};
  return json;
}

std::string difference_text(const FirstDifference& difference) {
  if (!difference.found_again)
    return fmt::format(
        "frame {}, but not again when it is repeated from the state before: a race, or memory that was not written",
        difference.frame);
  const StateDifference& state = difference.state;
  if (state.particles == 0)
    return fmt::format("sub-step {} of frame {}: {}", difference.substep, difference.frame, state.what);
  return fmt::format("sub-step {} of frame {}, particle {}: its {}; {} particle{}, up to {:.3g} dx and {:.3g} m/s",
                     difference.substep, difference.frame, state.particle, state.what, state.particles,
                     state.particles == 1 ? "" : "s", state.max_position_dx, state.max_velocity);
}

std::string verdict_text(const AgreeResult& result) {
  const auto& subjects = result.subjects;
  if (result.interrupted) return "interrupted: no verdict";
  const auto count = [&](auto condition) { return std::count_if(subjects.begin(), subjects.end(), condition); };
  const auto same = count([](const auto& s) { return s.bits == Verdict::same && !s.device_failed; });
  const auto failed = count([](const auto& s) { return s.device_failed; });
  const auto apart = count([](const auto& s) { return !s.device_failed && !s.agrees(); });
  const auto within = std::ssize(subjects) - same - failed -
                      count([](const auto& s) { return !s.device_failed && s.bits == Verdict::differs; });
  std::string text = fmt::format("same bits in {} of {} runs after each of {} frames", same, subjects.size(),
                                 subjects.front().hashes.size());
  if (within > 0) text += fmt::format("; {} without that promise within tolerance", within);
  if (apart > 0) text += fmt::format("; {} disagree", apart);
  if (failed > 0) text += fmt::format("; {} failed", failed);
  return (apart > 0 ? "DISAGREE: " : "AGREE: ") + text;
}

}  // namespace squall::harness
