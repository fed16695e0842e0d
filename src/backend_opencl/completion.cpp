#include "backend_opencl/completion.h"

namespace squall::opencl {

Completion::Completion(cl::Event event) : mark_(std::make_shared<Mark>()) {
  auto share = std::make_unique<std::shared_ptr<Mark>>(mark_);
  event.setCallback(CL_COMPLETE, &Completion::note, share.get());
  static_cast<void>(share.release());  // note() deletes it
}

void CL_CALLBACK Completion::note(cl_event, cl_int, void* data) {
  const auto now = std::chrono::steady_clock::now();
  const std::unique_ptr<std::shared_ptr<Mark>> share(static_cast<std::shared_ptr<Mark>*>(data));
  Mark& mark = **share;
  const std::lock_guard lock(mark.mutex);
  mark.time = now;
  mark.told.notify_all();
}

Completion::Time Completion::time(Time otherwise) const {
  std::unique_lock lock(mark_->mutex);
  mark_->told.wait_for(lock, std::chrono::seconds(1), [&] { return mark_->time.has_value(); });
  return mark_->time.value_or(otherwise);
}

void wait_for(const cl::Event& event, const char* description) {
  try {
    event.wait();
  } catch (const cl::Error& error) {
    const auto status = event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
    // -1, the code for a device that is not there, is what some drivers give commands that others took down with them.
    throw cl::Error(status < CL_DEVICE_NOT_FOUND ? status : error.err(), description);
  }
}

}  // namespace squall::opencl
