#pragma once

#include <string>

#include "harness/study/study_results.h"

namespace squall::app {

/// A study for people: what was measured, what it costs and how wrong it is, what chance makes of it, how it converges,
/// what is recommended.
std::string study_text(const harness::StudyResult& result);

}  // namespace squall::app
