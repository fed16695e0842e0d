#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "backend_opencl/cl.h"
#include "core/frame_report.h"

namespace squall::opencl {

/// Notes what host and queues do in a frame, for Settings::trace; does nothing while it is off.
///
/// Profiling events have the device's clock, which OpenCL 1.2 does not relate to the host's. But no command starts
/// before the host has asked for it, and none ends after the host has seen its queue finished: that bounds the
/// difference of the clocks from both sides, frame by frame. Its middle is taken, and half its width reported as
/// FrameReport::clock_error_ms.
class CommandTrace {
 public:
  using Moment = std::chrono::steady_clock::time_point;
  static constexpr const char* k_queue = "OpenCL queue";
  static constexpr const char* k_transfer_queue = "transfer queue";  ///< beside the sub-steps, part of none

  explicit CommandTrace(bool on) : on_(on) {}
  bool on() const { return on_; }

  /// A command that is enqueued next, or that was soon after `asked`. The event must live until take(); a lane is one
  /// in-order queue.
  void add(const cl::Event* event, std::string name, const char* lane = k_queue,
           Moment asked = std::chrono::steady_clock::now());
  /// Commands of the first lane from now on belong to the next sub-step; after end_substeps() to none.
  void begin_substep();
  void end_substeps() { in_substep_ = false; }
  /// The queue is seen finished now: all that was added to this lane before has ended.
  void finished(const char* lane = k_queue);
  /// Something the host did from `begin` until now.
  void host(const char* name, Moment begin);

  /// Moves everything into the report. All queues must be finished.
  void take(Moment frame_start, FrameReport& report);
  void clear();

 private:
  struct Command {
    const cl::Event* event;
    std::string name, lane;
    int substep;  ///< or -1
    Moment asked;
  };
  struct Wait {
    std::size_t commands;  ///< added before
    std::string lane;
    Moment seen;
  };
  struct HostSpan {
    const char* name;
    Moment begin, end;
  };
  void take_commands(Moment frame_start, FrameReport& report) const;

  bool on_, in_substep_ = false;
  int substeps_ = 0;
  std::vector<Command> commands_;
  std::vector<Wait> waits_;
  std::vector<HostSpan> host_;
};

/// What the device's clock must be set forward by to be the host's: the middle of what is possible, and how far off
/// that may be. [ms]
struct ClockShift {
  double shift = 0.0, error = 0.0;
};

/// A command or a wait, on one in-order queue: device times where commands ran, host times where the host was. [ms]
struct ClockBounds {
  std::vector<double> asked, started;  ///< host and device time of the same commands
  std::vector<double> seen, ended;     ///< host time of a wait's end and device time of the last command before it
};
ClockShift clock_shift(const ClockBounds& bounds);

}  // namespace squall::opencl
