#pragma once

#include <functional>
#include <vector>

#include "harness/agreement.h"
#include "harness/row.h"
#include "harness/run.h"

namespace squall::harness {

struct Comparison {
  std::vector<Row> rows;  ///< one per plan, in their order
  std::vector<std::vector<FrameRecord>> frames;
  Agreement agreement;
};

/// Called after every round (one frame of every run); false ends the comparison early.
using AfterRound = std::function<bool(int rounds_done, int rounds)>;

/// Runs all plans, interleaved frame by frame in rotating order, so that whatever else the machine does meets all of
/// them alike, and checks after every round that they agree. All plans must have the same number of frames and warm-up
/// frames. A device that fails gives an error row; the others go on.
Comparison compare(const SolverFactory& make, const std::vector<RunPlan>& plans, const AfterRound& after_round = {});

/// Order of the runs in a round. Runs that share processor threads (backend, device, thread count) stay together, so
/// that one pause per change is enough; groups and the members of each group take turns in coming first.
std::vector<std::size_t> order_of_round(const std::vector<RunPlan>& plans, int round);

}  // namespace squall::harness
