#pragma once

#include <string>
#include <vector>

#include "harness/results_json.h"
#include "harness/stress/stress.h"

namespace squall::harness {

/// {schema, context, quick, cases: [{number, name, required, run, backend, device.., verdict, why, findings}]}. No
/// number is infinite or NaN: such a value is null.
Json to_json(const Context& context, bool quick, const std::vector<StressResult>& results);

/// "largest over-density: 0.0415 (at most 0.01)".
std::string finding_text(const StressFinding& finding);

}  // namespace squall::harness
