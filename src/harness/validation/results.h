#pragma once

#include <string>
#include <vector>

#include "harness/context.h"
#include "harness/results_json.h"
#include "harness/validation/validate.h"

namespace squall::harness {

/// {schema, context, cases, as_expected, notes} (docs/validation.md). `interrupted` is there, true, if it was.
Json to_json(const Context& context, const std::vector<CaseResult>& results, const std::vector<std::string>& notes);

/// A table and what stands above it.
struct VerdictTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A line per check and run: measured against expected where they are furthest apart, error, tolerance, verdict.
VerdictTable verdict_table(const CaseResult& result);

/// The unit of a quantity of a case's runs; "" if no run has it.
std::string unit_of(const CaseResult& result, const std::string& quantity);

/// Why checks fail that should, what failed that should not and what passed that should not, one sentence each.
std::vector<std::string> remarks(const CaseResult& result);

/// "pass", "fails, as expected", "FAILS" or "PASSES, unexpected".
std::string verdict_text(const Verdict& verdict);

/// "dfsph on omp".
std::string run_name(const CaseRun& run);

/// In words: "rms difference, relative", ...
std::string measure_text(const Check& check);

/// 0.0123 as "0.0123": four digits; empty for what is not finite.
std::string short_number(double value);

}  // namespace squall::harness
