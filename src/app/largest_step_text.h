#pragma once

#include <string>
#include <vector>

#include "harness/stress/largest_step.h"

namespace squall::app {

/// The table of `squall stress --largest-step`: a row per search, what went wrong beyond the step under it.
std::string largest_step_text(const std::vector<harness::StepResult>& results);

}  // namespace squall::app
