#pragma once

#include <cstdint>
#include <string>

namespace squall::harness {

/// What a reader must know of dfsph's solves that ended at max_iterations, two of which each of `steps` sub-steps has:
/// a sentence; empty if there are none.
std::string unconverged_text(std::int64_t unconverged, std::int64_t steps);

}  // namespace squall::harness
