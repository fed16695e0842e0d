#pragma once

#include <string>
#include <vector>

#include "harness/stress/stress.h"

namespace squall::app {

/// A table of cases against subjects, what failed with its numbers and reasons, and a count of verdicts.
std::string stress_text(const std::vector<harness::StressSubject>& subjects,
                        const std::vector<harness::StressResult>& results);

}  // namespace squall::app
