#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/sweep.h"

namespace squall::harness {

/// What the search asks for: the size that a count really scales to, and a run at it; no point: interrupted.
struct BudgetProbe {
  std::function<std::int64_t(std::int64_t scene_particles)> real_size;
  std::function<std::optional<SweepPoint>(std::int64_t scene_particles)> measure;
};

/// Searches the largest scene whose median frame time keeps the budget: interpolates on the points of this run,
/// measures there, and where that is over the budget, again between that point and the one below, at most four times.
/// `largest` is always a size that was measured, never the estimate.
BudgetResult search_largest(const std::string& label, std::vector<SweepPoint> points, double budget_ms,
                            const BudgetProbe& probe);

}  // namespace squall::harness
