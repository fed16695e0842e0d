#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/report/plot.h"
#include "harness/validation/results.h"

namespace squall::harness {

/// A plot per check: what each run measured over time, what is expected, and the band of the tolerance around it. Names
/// are those of the case and the check, so unique.
std::vector<Plot> validation_plots(const CaseResult& result);

/// One page of everything that loads nothing from anywhere; `pictures`: name and SVG of each plot.
std::string validation_html(const Context& context, const std::vector<CaseResult>& results,
                            const std::vector<std::pair<std::string, std::string>>& pictures,
                            const std::vector<std::string>& notes);

}  // namespace squall::harness
