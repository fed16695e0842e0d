#pragma once

#include <string>

#include "harness/sweep_results.h"

namespace squall::app {

/// A sweep for people: what was measured, tables of sizes against runs, and what was found.
std::string sweep_text(const harness::SweepResult& result);

}  // namespace squall::app
