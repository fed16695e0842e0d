#pragma once

#include <optional>
#include <string>

#include "harness/compare.h"

namespace squall::app {

/// A comparison for people: devices, a line per run, phases, the water, whether they agree and, with a budget [ms],
/// which runs keep it.
std::string comparison_text(const harness::Comparison& comparison, std::optional<double> budget_ms);

}  // namespace squall::app
