#include "harness/stress/stress_results.h"

#include <fmt/format.h>

#include <cmath>

namespace squall::harness {

namespace {

const char* relation_name(StressFinding::Relation relation) {
  switch (relation) {
    case StressFinding::Relation::at_most:
      return "at_most";
    case StressFinding::Relation::at_least:
      return "at_least";
    case StressFinding::Relation::equal:
      return "equal";
    case StressFinding::Relation::information:
      break;
  }
  return "information";
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json finding_json(const StressFinding& finding) {
  Json json{{"what", finding.what}, {"value", number(finding.value)}, {"relation", relation_name(finding.relation)}};
  if (finding.relation != StressFinding::Relation::information) {
    json["limit"] = number(finding.limit);
    json["holds"] = finding.holds();
  }
  return json;
}

Json result_json(const StressResult& result) {
  const Settings& settings = result.subject.settings;
  Json json{{"number", result.tried->number},
            {"name", result.tried->name},
            {"required", result.tried->required},
            {"label", result.subject.label},
            {"backend", result.subject.backend},
            {"pressure", to_string(settings.pressure)},
            {"precision", to_string(settings.precision)},
            {"threads", settings.threads},
            {"verdict", to_string(result.verdict)},
            {"wall_s", result.wall_s}};
  if (!result.why.empty()) json["why"] = result.why;
  if (!result.outcome.not_applicable.empty()) json["not_applicable"] = result.outcome.not_applicable;
  if (!result.outcome.error.empty()) json["error"] = result.outcome.error;
  json["findings"] = Json::array();
  for (const StressFinding& finding : result.outcome.findings) json["findings"].push_back(finding_json(finding));
  return json;
}

}  // namespace

Json to_json(const Context& context, bool quick, const std::vector<StressResult>& results) {
  Json json;
  json["schema"] = k_result_schema;
  json["context"] = to_json(context);
  json["quick"] = quick;
  json["cases"] = Json::array();
  for (const StressResult& result : results) json["cases"].push_back(result_json(result));
  return json;
}

std::string finding_text(const StressFinding& finding) {
  std::string text = fmt::format("{}: {:.4g}", finding.what, finding.value);
  switch (finding.relation) {
    case StressFinding::Relation::at_most:
      return fmt::format("{} (at most {:.4g})", text, finding.limit);
    case StressFinding::Relation::at_least:
      return fmt::format("{} (at least {:.4g})", text, finding.limit);
    case StressFinding::Relation::equal:
      return fmt::format("{} (exactly {:.4g})", text, finding.limit);
    case StressFinding::Relation::information:
      break;
  }
  return text;
}

}  // namespace squall::harness
