#pragma once

#include <string>
#include <vector>

#include "harness/validation/validate.h"

namespace squall::app {

/// A case's table and remarks for a terminal.
std::string case_text(const harness::CaseResult& result);

/// How many checks passed, failed as expected, and were a surprise.
std::string validation_summary(const std::vector<harness::CaseResult>& results);

/// What there is: the cases that come with squall, quantities, formulas and measures of checks.
std::string validation_list();

}  // namespace squall::app
