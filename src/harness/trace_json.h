#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "harness/context.h"
#include "harness/row.h"

namespace squall::harness {

/// A run as the trace knows it: a process of its own, with a lane per thread or queue.
struct TracedRun {
  std::string label;
  const std::vector<FrameRecord>* frames = nullptr;
};

/// Frames without spans are left out, with those behind them (Run keeps k_max_spans).
std::size_t traced_frames(const std::vector<FrameRecord>& frames);

/// Writes what happened when in the Trace Event Format, which ui.perfetto.dev and chrome://tracing open
/// (docs/trace.md): complete events in microseconds since the first frame; children lie within their parents to the
/// nanosecond.
void write_trace(std::ostream& out, const Context& context, const std::vector<TracedRun>& runs);

}  // namespace squall::harness
