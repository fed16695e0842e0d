#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <string>
#include <utility>

#include "backend_opencl/cl.h"
#include "backend_opencl/command_trace.h"

namespace squall::opencl {

/// Phase of everything that delivers positions.
inline constexpr const char* k_readback_phase = "readback";

/// What the commands of a frame cost on the device [ms].
struct DeviceTimes {
  std::map<std::string, double> phases;
  double readback = 0.0;         ///< that phase again
  double readback_hidden = 0.0;  ///< the part of it during which commands of other phases ran
};

/// Puts commands into a queue and, if it profiles, adds up what they cost by phase and notes them in the trace.
class Launcher {
 public:
  /// The queue profiles if either is asked for.
  Launcher(cl::CommandQueue queue, bool profile, bool trace = false)
      : queue_(std::move(queue)), profile_(profile || trace), trace_(trace) {}

  cl::CommandQueue& queue() { return queue_; }
  CommandTrace& trace() { return trace_; }

  /// One dimension; global is a multiple of local.
  void run(const cl::Kernel& kernel, std::size_t global, std::size_t local, const char* phase) {
    cl::Event* slot = trace_.on() ? event(phase, kernel.getInfo<CL_KERNEL_FUNCTION_NAME>()) : event(phase);
    queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(global), cl::NDRange(local), nullptr, slot);
  }

  /// Where the next command's event goes: null unless profiling.
  cl::Event* event(const char* phase) { return event(phase, phase); }

  /// How a command stands in the trace: its name, its queue's lane, and a moment before it was enqueued.
  struct Traced {
    const char* name;
    const char* lane;
    CommandTrace::Moment asked;
  };
  /// Counts a command, of this or another queue of the device, with a phase.
  void note(const cl::Event& event, const char* phase, const Traced& traced) {
    if (profile_) trace_.add(&events_.emplace_back(phase, event).second, traced.name, traced.lane, traced.asked);
  }

  /// Of the commands since the last call; nothing unless profiling. The queues must be finished.
  DeviceTimes take_times();

 private:
  /// `name` is the command's in the trace.
  cl::Event* event(const char* phase, std::string name) {
    if (!profile_) return nullptr;
    cl::Event* slot = &events_.emplace_back(phase, cl::Event()).second;
    trace_.add(slot, std::move(name));
    return slot;
  }

  cl::CommandQueue queue_;
  bool profile_;
  CommandTrace trace_;
  std::list<std::pair<const char*, cl::Event>> events_;
};

}  // namespace squall::opencl
