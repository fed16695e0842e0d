#include <fmt/format.h>

#include "harness/study/study_results.h"

namespace squall::harness {

namespace {

std::string error_text(const ErrorFinding& error) {
  if (error.at_floor()) return fmt::format("at the noise floor ({:.2g})", *error.floor);
  return fmt::format("{:.2g}", error.value);
}

std::string described(const StudyResult& result, std::size_t i) {
  const PointFinding& point = result.findings.points[i];
  return fmt::format("{}: {:.3g} s of wall clock per simulated second, 95 % of frames within {:.3g} ms, {} error {}",
                     result.runs.points.points[i].name, point.cost, point.frame_ms_p95, result.question.error,
                     error_text(*result.ranked_error(i)));
}

std::string chosen(const StudyResult& result, const std::string& what, const std::optional<std::size_t>& point) {
  if (!point) return what + ": none of the settings that were measured";
  return what + ": " + described(result, *point) + "\n  " + result.point_commands[*point].command;
}

/// The last of the front that gains something: what follows costs more and is no better than chance.
std::optional<std::size_t> first_at_floor(const StudyResult& result) {
  for (const auto i : result.findings.front)
    if (result.ranked_error(i)->at_floor()) return i;
  return std::nullopt;
}

}  // namespace

std::vector<std::string> recommendations(const StudyResult& result) {
  std::vector<std::string> texts;
  const auto& front = result.findings.front;
  const auto& question = result.question;
  if (front.empty())
    texts.push_back(fmt::format("no setting has both a time and the {} error{}: nothing can be recommended",
                                question.error, result.runs.interrupted ? " yet" : ""));
  if (question.max_error)
    texts.push_back(chosen(result, fmt::format("cheapest with an error of at most {:g}", *question.max_error),
                           result.findings.cheapest));
  if (question.budget_ms)
    texts.push_back(
        chosen(result, fmt::format("most accurate within {:g} ms a frame", *question.budget_ms), result.findings.best));
  if (front.empty() || question.max_error || question.budget_ms) return texts;
  texts.push_back(chosen(result, "cheapest of all", front.front()));
  if (front.size() > 1) texts.push_back(chosen(result, "most accurate of all", front.back()));
  if (const auto floor = first_at_floor(result); floor && *floor != front.back() && *floor != front.front())
    texts.push_back(chosen(result, "cheapest whose error is at the noise floor", floor));
  return texts;
}

}  // namespace squall::harness
