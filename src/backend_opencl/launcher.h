#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <string>
#include <utility>

#include "backend_opencl/cl.h"

namespace squall::opencl {

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

  /// [ms] by phase since the last call. The queue must be finished.
  std::map<std::string, double> take_times() {
    std::map<std::string, double> times;
    for (const auto& [phase, event] : events_) {
      const auto begin = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
      const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
      times[phase] += 1e-6 * static_cast<double>(end - begin);
    }
    events_.clear();
    return times;
  }

 private:
  cl::CommandQueue queue_;
  bool profile_;
  std::list<std::pair<const char*, cl::Event>> events_;
};

}  // namespace squall::opencl
