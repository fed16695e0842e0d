#include "harness/study/pareto.h"

namespace squall::harness {

namespace {

bool beats(const Choice& a, const Choice& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

}  // namespace

std::vector<bool> pareto_front(const std::vector<Choice>& choices) {
  std::vector<bool> front(choices.size(), true);
  for (std::size_t i = 0; i < choices.size(); ++i)
    for (std::size_t j = 0; j < choices.size(); ++j) {
      const bool twin = j < i && choices[j].cost == choices[i].cost && choices[j].error == choices[i].error;
      if (twin || beats(choices[j], choices[i])) front[i] = false;
    }
  return front;
}

std::optional<std::size_t> cheapest_within(const std::vector<Choice>& choices, double max_error) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].error <= max_error && (!best || choices[i].cost < choices[*best].cost)) best = i;
  return best;
}

std::optional<std::size_t> best_within(const std::vector<Choice>& choices, double budget_ms) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i].frame_ms > budget_ms) continue;
    const bool better = !best || choices[i].error < choices[*best].error ||
                        (choices[i].error == choices[*best].error && choices[i].cost < choices[*best].cost);
    if (better) best = i;
  }
  return best;
}

}  // namespace squall::harness
