#pragma once

#include <vector>

namespace squall::opencl {

/// From when to when a command ran [ms], begin <= end.
struct Span {
  double begin = 0.0, end = 0.0;
};

/// Time that the spans take, each for itself.
double total(const std::vector<Span>& spans);

/// Part of that time during which at least one of the `others` ran.
double hidden(const std::vector<Span>& spans, std::vector<Span> others);

}  // namespace squall::opencl
