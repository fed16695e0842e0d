#pragma once

#include <string>
#include <vector>

#include "harness/row.h"

namespace squall::harness {

/// What a reader must know of a run of dfsph whose water is denser than its tolerance asks for, a sentence each: solves
/// that ended at max_iterations, and frames that ended with a mean over-density of more than ten tolerances (and 1 %),
/// whatever the reason. None of other pressure solvers, which promise no density.
std::vector<std::string> water_warnings(const Row& row);

}  // namespace squall::harness
