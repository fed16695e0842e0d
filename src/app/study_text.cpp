#include "app/study_text.h"

#include <fmt/format.h>

#include "app/table.h"
#include "app/terminal.h"
#include "harness/study/study_tables.h"

namespace squall::app {

namespace {

std::string table_text(const harness::ResultTable& what) {
  if (what.rows.empty()) return "";
  Table table(what.header);
  for (const auto& row : what.rows) table.add(row);
  return "\n" + what.title + "\n" + table.text();
}

std::string reasons(const harness::StudyResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.findings.points.size(); ++i) {
    const auto& point = result.findings.points[i];
    if (!point.reason.empty())
      text += fmt::format("{}: {}: {}\n",
                          point.status == harness::PointStatus::fine ? "not ranked" : red(to_string(point.status)),
                          result.runs.points.points[i].name, point.reason);
  }
  return text.empty() ? "" : "\n" + text;
}

}  // namespace

std::string study_text(const harness::StudyResult& result) {
  std::string text = harness::study_headline(result) + "\n";
  text += table_text(harness::cost_table(result));
  text += reasons(result);
  text += table_text(harness::error_table(result, false));
  text += table_text(harness::noise_table(result));
  text += "\n";
  if (result.findings.yardstick)
    text += fmt::format("yardstick of the errors above: the reference of {}\n",
                        result.runs.points.models[*result.findings.yardstick].name);
  for (const auto& line : harness::recommendations(result)) text += line + "\n";
  return text;
}

}  // namespace squall::app
