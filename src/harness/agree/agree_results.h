#pragma once

#include "harness/agree/agree.h"
#include "harness/results_json.h"

namespace squall::harness {

const char* to_string(Verdict verdict);

/// {schema, context, scene, settings, runs, pairs, double_precision, agreement} (docs/agree.md).
Json to_json(const Context& context, const SceneInfo& scene, const AgreeResult& result);

/// Where two runs part, one sentence without a full stop: "sub-step 3 of frame 12, particle 7: position, ...".
std::string difference_text(const FirstDifference& difference);

/// One sentence for all of it.
std::string verdict_text(const AgreeResult& result);

}  // namespace squall::harness
