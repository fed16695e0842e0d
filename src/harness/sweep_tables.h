#pragma once

#include <string>
#include <vector>

#include "harness/sweep_results.h"

namespace squall::harness {

/// A table for people, on a terminal or a page.
struct ResultTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A line per size, a column per run: frames per second, milliseconds, speed-up, times real time. The speed-up is left
/// out where no run has one.
std::vector<ResultTable> size_tables(const SweepResult& result);

/// Every point with its tails.
ResultTable point_table(const SweepResult& result);

/// Every OpenCL run against OpenMP, size by size.
ResultTable lead_table(const SweepResult& result);

/// The largest scene of each run within the budget.
ResultTable budget_table(const SweepResult& result);

}  // namespace squall::harness
