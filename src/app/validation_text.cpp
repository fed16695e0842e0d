#include "app/validation_text.h"

#include <fmt/format.h>

#include "app/builtin_cases.h"
#include "app/table.h"
#include "app/terminal.h"
#include "harness/validation/formulas.h"
#include "harness/validation/observer.h"
#include "harness/validation/results.h"

namespace squall::app {

namespace {

bool is_surprise(const std::string& remark) {
  return remark.find(": FAILS") != std::string::npos || remark.find(": PASSES, unexpected") != std::string::npos;
}

std::string line_of(const harness::CaseRun& run) {
  return fmt::format("  {}: {} particles, {:.4g} s of water in {} sub-steps, {:.1f} s\n", harness::run_name(run),
                     with_commas(run.particles), run.simulated_s, with_commas(run.steps), run.wall_s);
}

}  // namespace

std::string case_text(const harness::CaseResult& result) {
  const auto& what = result.what;
  std::string text = bold(what.name + ": " + what.title) + "\n";
  text += fmt::format("  source: {}\n", what.source);
  for (const auto& run : result.runs) text += line_of(run);
  const auto content = harness::verdict_table(result);
  Table table(content.header);
  for (const auto& row : content.rows) table.add(row);
  text += table.text();
  for (const auto& check : what.checks) {
    text += fmt::format("  {}: {}; tolerance: {}\n", check.name, harness::measure_text(check), check.tolerance_why);
    if (check.source != what.source) text += fmt::format("    source: {}\n", check.source);
  }
  for (const auto& remark : harness::remarks(result)) {
    const std::string line = "  " + remark;
    text += (is_surprise(remark) ? red(line) : line) + "\n";
  }
  return text + "\n";
}

std::string validation_summary(const std::vector<harness::CaseResult>& results) {
  int passed = 0, failed = 0, surprises = 0, interrupted = 0;
  for (const auto& result : results)
    for (const auto& run : result.runs)
      for (const auto& verdict : run.verdicts) {
        if (run.interrupted)
          ++interrupted;
        else if (!verdict.as_expected())
          ++surprises;
        else
          ++(verdict.finding.passed ? passed : failed);
      }
  std::string text = fmt::format("{} passed, {} failed as expected, {} unexpected", passed, failed, surprises);
  if (interrupted > 0) text += fmt::format(", {} interrupted", interrupted);
  return (surprises > 0 ? red(text) : text) + "\n";
}

std::string validation_list() {
  Table cases({"case", "what", "source"}, true);
  for (const auto& name : builtin_case_names()) {
    const harness::Case entry = builtin_case(name);
    cases.add({name, entry.title, entry.source});
  }
  Table quantities({"quantity", "unit", "meaning", "needs"}, true);
  for (const auto& quantity : harness::quantities())
    quantities.add({quantity.name, quantity.unit, quantity.meaning, quantity.needs});
  Table formulas({"formula", "meaning", "parameters"}, true);
  formulas.add({"start", "the first measured value from from_s on: what should not change", ""});
  for (const auto& formula : harness::formulas())
    formulas.add({formula.name, formula.meaning, fmt::format("{}", fmt::join(formula.parameters, ", "))});
  return cases.text() + "\n" + quantities.text() + "Gauges of the scene, by their names (docs/scenes.md).\n\n" +
         formulas.text() + "\nmeasures: max, rms, mean, slope, line, period, below, above (docs/validation.md)\n";
}

}  // namespace squall::app
