#include "backend_opencl/pinned_memory.h"

namespace squall::opencl {

PinnedMemory::PinnedMemory(Machine& machine, std::size_t bytes)
    : queue_(machine.queue), buffer_(machine.context, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes) {
  memory_ = queue_.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes);
}

PinnedMemory::~PinnedMemory() {
  try {
    queue_.enqueueUnmapMemObject(buffer_, memory_);
    queue_.finish();
  } catch (const cl::Error&) {
    // The device is gone, and its memory with it.
  }
}

}  // namespace squall::opencl
