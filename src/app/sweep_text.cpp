#include "app/sweep_text.h"

#include <fmt/format.h>

#include "app/table.h"
#include "app/terminal.h"
#include "harness/sweep_report.h"
#include "harness/sweep_tables.h"

namespace squall::app {

std::string sweep_text(const harness::SweepResult& result) {
  std::string text = fmt::format("{}: {}\n", result.scene.name, harness::measured_part(result));
  for (const auto& size_table : harness::size_tables(result)) {
    Table table(size_table.header);
    for (const auto& row : size_table.rows) table.add(row);
    text += "\n" + size_table.title + "\n" + table.text();
  }
  text += "\n";
  const bool agree = harness::overall_agreement(result.sweep).agree;
  for (const auto& finding : harness::sweep_findings(result))
    text += (!agree && finding.rfind("agreement", 0) == 0 ? red(finding) : finding) + "\n";
  return text;
}

}  // namespace squall::app
