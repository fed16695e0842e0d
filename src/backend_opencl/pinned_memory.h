#pragma once

#include <cstddef>

#include "backend_opencl/device.h"

namespace squall::opencl {

/// Host memory that a driver allocated (CL_MEM_ALLOC_HOST_PTR), so that transfers need no detour; mapped once, for its
/// whole life. Nothing may be in flight into it when it goes.
class PinnedMemory {
 public:
  /// At least one byte.
  PinnedMemory(Machine& machine, std::size_t bytes);
  ~PinnedMemory();
  PinnedMemory(const PinnedMemory&) = delete;
  PinnedMemory& operator=(const PinnedMemory&) = delete;

  void* data() const { return memory_; }

 private:
  cl::CommandQueue queue_;
  cl::Buffer buffer_;
  void* memory_ = nullptr;
};

}  // namespace squall::opencl
