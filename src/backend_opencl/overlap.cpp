#include "backend_opencl/overlap.h"

#include <algorithm>
#include <utility>

namespace squall::opencl {

namespace {

/// The same times as spans that do not touch each other, in order.
std::vector<Span> merged(std::vector<Span> spans) {
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.begin < b.begin; });
  std::vector<Span> result;
  for (const Span& span : spans) {
    if (result.empty() || span.begin > result.back().end)
      result.push_back(span);
    else
      result.back().end = std::max(result.back().end, span.end);
  }
  return result;
}

}  // namespace

double total(const std::vector<Span>& spans) {
  double sum = 0.0;
  for (const Span& span : spans) sum += span.end - span.begin;
  return sum;
}

double hidden(const std::vector<Span>& spans, std::vector<Span> others) {
  others = merged(std::move(others));
  double sum = 0.0;
  for (const Span& span : spans)
    for (const Span& other : others)
      sum += std::max(0.0, std::min(span.end, other.end) - std::max(span.begin, other.begin));
  return sum;
}

}  // namespace squall::opencl
