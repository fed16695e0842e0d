#pragma once

#include <vector>

#include "harness/results_json.h"
#include "harness/stress/largest_step.h"

namespace squall::harness {

/// {schema, context, quick, interrupted, largest_steps: [{pressure, precision, backend, device.., largest_step_s,
/// bounds_s, ..}]}. No number is infinite or NaN: such a value is null.
Json to_json(const Context& context, bool quick, bool interrupted, const std::vector<StepResult>& results);

}  // namespace squall::harness
