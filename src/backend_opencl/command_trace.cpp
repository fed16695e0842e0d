#include "backend_opencl/command_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace squall::opencl {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(CommandTrace::Moment begin, CommandTrace::Moment end) {
  return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// Device times [ms] of a command.
struct Stretch {
  double begin, end;
};

/// Since `epoch` [ns of the device]: a device's clock may count from years ago, and doubles have 53 bits.
Stretch stretch_of(const cl::Event& event, cl_ulong epoch) {
  const auto since = [epoch](cl_ulong time) { return 1e-6 * static_cast<double>(static_cast<cl_long>(time - epoch)); };
  return {since(event.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
          since(event.getProfilingInfo<CL_PROFILING_COMMAND_END>())};
}

}  // namespace

ClockShift clock_shift(const ClockBounds& bounds) {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < bounds.asked.size(); ++i) least = std::max(least, bounds.asked[i] - bounds.started[i]);
  for (std::size_t i = 0; i < bounds.seen.size(); ++i) most = std::min(most, bounds.seen[i] - bounds.ended[i]);
  if (!std::isfinite(least) || !std::isfinite(most)) return {};
  // A clock that does not tell the truth may leave nothing between the bounds: the gap is then the error.
  return {0.5 * (least + most), 0.5 * std::abs(most - least)};
}

void CommandTrace::add(const cl::Event* event, std::string name, const char* lane, Moment asked) {
  if (!on_ || event == nullptr) return;
  const bool in_substep = in_substep_ && std::string_view(lane) == k_queue;
  commands_.push_back({event, std::move(name), lane, in_substep ? substeps_ - 1 : -1, asked});
}

void CommandTrace::begin_substep() {
  in_substep_ = true;
  ++substeps_;
}

void CommandTrace::finished(const char* lane) {
  if (on_) waits_.push_back({commands_.size(), lane, Clock::now()});
}

void CommandTrace::host(const char* name, Moment begin) {
  if (on_) host_.push_back({name, begin, Clock::now()});
}

void CommandTrace::clear() {
  commands_.clear();
  waits_.clear();
  host_.clear();
  substeps_ = 0;
  in_substep_ = false;
}

void CommandTrace::take(Moment frame_start, FrameReport& report) {
  if (on_) {
    for (const auto& span : host_)
      report.spans.push_back(
          {span.name, "host", milliseconds(frame_start, span.begin), milliseconds(frame_start, span.end)});
    if (!commands_.empty()) take_commands(frame_start, report);
  }
  clear();
}

void CommandTrace::take_commands(Moment frame_start, FrameReport& report) const {
  const auto epoch = commands_.front().event->getProfilingInfo<CL_PROFILING_COMMAND_START>();
  std::vector<Stretch> stretches;
  ClockBounds bounds;
  for (const auto& command : commands_) {
    stretches.push_back(stretch_of(*command.event, epoch));
    bounds.asked.push_back(milliseconds(frame_start, command.asked));
    bounds.started.push_back(stretches.back().begin);
  }
  for (const auto& wait : waits_) {
    for (std::size_t i = wait.commands; i-- > 0;) {
      if (commands_[i].lane != wait.lane) continue;
      bounds.seen.push_back(milliseconds(frame_start, wait.seen));
      bounds.ended.push_back(stretches[i].end);
      break;
    }
  }
  const ClockShift clock = clock_shift(bounds);
  report.clock_error_ms = clock.error;

  for (std::size_t first = 0; first < commands_.size();) {
    const Command& command = commands_[first];
    std::size_t end = first + 1;
    while (end < commands_.size() && commands_[end].substep == command.substep && commands_[end].lane == command.lane)
      ++end;
    if (command.substep >= 0)
      report.spans.push_back(
          {"sub-step", command.lane, stretches[first].begin + clock.shift, stretches[end - 1].end + clock.shift});
    for (; first < end; ++first)
      report.spans.push_back({commands_[first].name, commands_[first].lane, stretches[first].begin + clock.shift,
                              stretches[first].end + clock.shift});
  }
}

}  // namespace squall::opencl
