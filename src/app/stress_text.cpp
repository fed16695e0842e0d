#include "app/stress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "app/table.h"
#include "app/terminal.h"
#include "harness/stress/stress_results.h"

namespace squall::app {

namespace {

using harness::StressResult;
using harness::StressVerdict;

const char* cell(StressVerdict verdict) {
  switch (verdict) {
    case StressVerdict::passed:
      return "ok";
    case StressVerdict::failed_as_expected:
      return "known";
    case StressVerdict::not_applicable:
      return "-";
    case StressVerdict::failed:
      return "FAILED";
    case StressVerdict::passed_unexpectedly:
      break;
  }
  return "HELD";
}

/// What failed, or what held though it is known to fail.
std::string account_of(const StressResult& result) {
  std::string text = fmt::format("{} {}, {}: {}\n", result.tried->number, result.tried->name, result.subject.label,
                                 result.unexpected() ? red(to_string(result.verdict)) : "failed as expected");
  if (!result.outcome.error.empty()) text += "    " + result.outcome.error + "\n";
  constexpr int k_most_lines = 4;
  int lines = 0, more = 0;
  for (const auto& finding : result.outcome.findings) {
    if (finding.holds()) continue;
    if (++lines <= k_most_lines)
      text += "    " + harness::finding_text(finding) + "\n";
    else
      ++more;
  }
  if (more > 0) text += fmt::format("    and {} more, all in the JSON\n", more);
  if (!result.why.empty()) text += "    known: " + result.why + "\n";
  return text;
}

}  // namespace

std::string stress_text(const std::vector<harness::StressSubject>& subjects, const std::vector<StressResult>& results) {
  std::string text;
  for (std::size_t i = 0; i < subjects.size(); ++i) text += fmt::format("{}: {}\n", i + 1, subjects[i].label);
  std::vector<std::string> header{"case", "required"};
  for (std::size_t i = 0; i < subjects.size(); ++i) header.push_back(std::to_string(i + 1));
  Table table(header, true);
  for (std::size_t i = 0; i < results.size();) {
    const auto* tried = results[i].tried;
    std::vector<std::string> cells{fmt::format("{:2} {}", tried->number, tried->name), tried->required};
    for (; i < results.size() && results[i].tried == tried; ++i) cells.push_back(cell(results[i].verdict));
    cells.resize(header.size());
    table.add(cells);
  }
  text += "\n" + table.text() + "\n";
  std::map<StressVerdict, int> counts;
  for (const auto& result : results) {
    ++counts[result.verdict];
    if (result.unexpected() || result.verdict == StressVerdict::failed_as_expected) text += account_of(result);
  }
  text += fmt::format("{} passed, {} failed as expected, {} not applicable, ", counts[StressVerdict::passed],
                      counts[StressVerdict::failed_as_expected], counts[StressVerdict::not_applicable]);
  const int unexpected = counts[StressVerdict::failed] + counts[StressVerdict::passed_unexpectedly];
  const std::string end = fmt::format("{} unexpected\n", unexpected);
  return text + (unexpected > 0 ? red(end) : end);
}

}  // namespace squall::app
