#include "backend_opencl/launcher.h"

#include <string_view>
#include <vector>

#include "backend_opencl/overlap.h"

namespace squall::opencl {

namespace {

/// Since `origin` [ns]: the clock itself counts further than a double can.
Span span_of(const cl::Event& event, cl_ulong origin) {
  const auto since = [&](cl_ulong time) { return 1e-6 * static_cast<double>(static_cast<cl_long>(time - origin)); };
  return {since(event.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
          since(event.getProfilingInfo<CL_PROFILING_COMMAND_END>())};
}

}  // namespace

DeviceTimes Launcher::take_times() {
  DeviceTimes times;
  if (events_.empty()) return times;
  const auto origin = events_.front().second.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  std::vector<Span> readback, others;
  for (const auto& [phase, event] : events_) {
    const Span span = span_of(event, origin);
    times.phases[phase] += span.end - span.begin;
    (std::string_view(phase) == k_readback_phase ? readback : others).push_back(span);
  }
  events_.clear();
  times.readback = total(readback);
  times.readback_hidden = hidden(readback, others);
  return times;
}

}  // namespace squall::opencl
