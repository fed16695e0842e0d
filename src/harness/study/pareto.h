#pragma once

#include <optional>
#include <string>
#include <vector>

namespace squall::harness {

/// A setting as something to choose: what it costs, how wrong it is.
struct Choice {
  double cost = 0.0;      ///< wall seconds per simulated second
  double error = 0.0;     ///< at least the noise floor: nothing below it is told apart
  double frame_ms = 0.0;  ///< 95th percentile
};

/// Which choices no other one beats: none costs as little or less and errs as little or less, one of them less.
/// Of equal ones the first.
std::vector<bool> pareto_front(const std::vector<Choice>& choices);

/// The cheapest choice with an error of at most this; empty if there is none.
std::optional<std::size_t> cheapest_within(const std::vector<Choice>& choices, double max_error);

/// The choice of least error, and of these the cheapest, whose frames take at most so long; empty if there is none.
std::optional<std::size_t> best_within(const std::vector<Choice>& choices, double budget_ms);

}  // namespace squall::harness
