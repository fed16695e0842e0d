#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>

#include "backend_opencl/cl.h"

namespace squall::opencl {

/// When a command was done, as the driver tells it at that moment. A host that waits for the event learns of it only
/// when it has woken up, and what follows in the queue may be over by then.
class Completion {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Completion(cl::Event event);

  /// The time. The command must have finished; `otherwise`, if the driver has not told within a second.
  Time time(Time otherwise) const;

 private:
  struct Mark {
    std::mutex mutex;
    std::condition_variable told;
    std::optional<Time> time;
  };
  static void CL_CALLBACK note(cl_event event, cl_int status, void* mark);

  std::shared_ptr<Mark> mark_;  // the callback owns it too: it may come late
};

/// Waits until a command is done. Throws cl::Error with the command's own status and this description if it failed:
/// finishing a queue says nothing of that.
void wait_for(const cl::Event& event, const char* description);

}  // namespace squall::opencl
