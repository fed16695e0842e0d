#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <string>
#include <utility>

#include "backend_opencl/cl.h"

namespace squall::opencl {

/// Phase of everything that delivers positions.
inline constexpr const char* k_readback_phase = "readback";

/// What the commands of a frame cost on the device [ms].
struct DeviceTimes {
  std::map<std::string, double> phases;
  double readback = 0.0;         ///< that phase again
  double readback_hidden = 0.0;  ///< the part of it during which commands of other phases ran
};

/// Puts commands into a queue and, if it profiles, adds up what they cost by phase.
class Launcher {
 public:
  Launcher(cl::CommandQueue queue, bool profile) : queue_(std::move(queue)), profile_(profile) {}

  cl::CommandQueue& queue() { return queue_; }

  /// One dimension; global is a multiple of local.
  void run(const cl::Kernel& kernel, std::size_t global, std::size_t local, const char* phase) {
    queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(global), cl::NDRange(local), nullptr, event(phase));
  }

  /// Where the next command's event goes: null unless profiling.
  cl::Event* event(const char* phase) { return profile_ ? &events_.emplace_back(phase, cl::Event()).second : nullptr; }

  /// Counts a command, of this or another queue of the device, with a phase.
  void note(const cl::Event& event, const char* phase) {
    if (profile_) events_.emplace_back(phase, event);
  }

  /// Of the commands since the last call; nothing unless profiling. The queues must be finished.
  DeviceTimes take_times();

 private:
  cl::CommandQueue queue_;
  bool profile_;
  std::list<std::pair<const char*, cl::Event>> events_;
};

}  // namespace squall::opencl
