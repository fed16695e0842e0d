#include "backend_opencl/readback.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "backend_opencl/kernel_arguments.h"

namespace squall::opencl {

namespace {

constexpr std::size_t k_position_bytes = 16;  // float4
constexpr std::size_t k_record_bytes = 32;

std::size_t staging_bytes(const Layout& layout) { return std::max<std::size_t>(layout.capacity, 1) * k_position_bytes; }

bool stages(Readback mode) { return mode == Readback::blocking || mode == Readback::pinned; }

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

bool shares_host_memory(Machine& machine, const cl::Program& program) {
  if (!machine.device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>()) return false;
  constexpr std::size_t k_words = 4096;
  constexpr cl_uint k_patterns[] = {0x5eed0001u, 0xa5a50003u};
  const Pages pages = allocate_pages(k_words * sizeof(cl_uint));
  const cl::Buffer buffer(machine.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, k_words * sizeof(cl_uint),
                          pages.get());
  cl::Kernel kernel(program, "probe_memory");
  std::vector<cl_uint> seen(k_words);
  for (const cl_uint pattern : k_patterns) {
    set_arguments(kernel, buffer, pattern);
    machine.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(k_words), cl::NDRange(64));
    machine.queue.finish();
    // Not mapped: only a device that works on this very memory has changed it.
    std::memcpy(seen.data(), pages.get(), k_words * sizeof(cl_uint));
    for (std::size_t i = 0; i < k_words; ++i)
      if (seen[i] != pattern + static_cast<cl_uint>(i)) return false;
  }
  return true;
}

PositionReader::PositionReader(Machine& machine, const cl::Program& program, const Buffers& buffers,
                               const Layout& layout, const WorkShape& shape, bool shared)
    : mode_(layout.readback),
      shared_(shared),
      shape_(shape),
      queue_(machine.queue),
      records_(buffers.records),
      stage_(program, "stage_positions") {
  if (!stages(mode_)) return;
  staging_ = cl::Buffer(machine.context, CL_MEM_READ_WRITE, staging_bytes(layout));
  set_arguments(stage_, records_, staging_, 0);
  if (mode_ == Readback::blocking) {
    pageable_.resize(staging_bytes(layout) / sizeof(float));
  } else {
    pinned_ = cl::Buffer(machine.context, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, staging_bytes(layout));
    pinned_memory_ = static_cast<float*>(
        queue_.enqueueMapBuffer(pinned_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, staging_bytes(layout)));
  }
}

PositionReader::~PositionReader() {
  try {
    withdraw();
    if (pinned_memory_) queue_.enqueueUnmapMemObject(pinned_, pinned_memory_);
    queue_.finish();
  } catch (const cl::Error&) {
    // The device is gone, and its memory with it.
  }
}

std::vector<MemoryNeed> PositionReader::memory_needs(const Layout& layout) {
  std::vector<MemoryNeed> needs;
  if (stages(layout.readback)) needs.push_back({"staged positions", staging_bytes(layout)});
  if (layout.readback == Readback::pinned) needs.push_back({"pinned positions", staging_bytes(layout)});
  return needs;
}

void PositionReader::warm_up(Launcher& launcher) {
  if (stages(mode_)) enqueue_staging(launcher, 0);
}

void PositionReader::withdraw() {
  view_ = {};
  blocked_ms_ = 0.0;
  bytes_ = 0;
  if (!mapped_) return;
  queue_.enqueueUnmapMemObject(records_, mapped_);
  mapped_ = nullptr;
}

void PositionReader::enqueue_staging(Launcher& launcher, int count) {
  stage_.setArg(2, count);
  launcher.run(stage_, shape_.particles, shape_.group, "readback");
}

void PositionReader::after_substep(Launcher& launcher, int count) {
  if (mode_ != Readback::blocking || count == 0) return;
  queue_.finish();
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t bytes = static_cast<std::size_t>(count) * k_position_bytes;
  enqueue_staging(launcher, count);
  queue_.enqueueReadBuffer(staging_, CL_TRUE, 0, bytes, pageable_.data(), nullptr, launcher.event("readback"));
  blocked_ms_ += milliseconds_since(begin);
  bytes_ += bytes;
  view_ = {pageable_.data(), 4, static_cast<std::size_t>(count)};
}

void PositionReader::enqueue_delivery(Launcher& launcher, int count) {
  if (count == 0) return;
  const auto size = static_cast<std::size_t>(count);
  if (mode_ == Readback::pinned) {
    enqueue_staging(launcher, count);
    queue_.enqueueReadBuffer(staging_, CL_FALSE, 0, size * k_position_bytes, pinned_memory_, nullptr,
                             launcher.event("readback"));
    bytes_ += size * k_position_bytes;
    view_ = {pinned_memory_, 4, size};
  } else if (mode_ == Readback::mapped) {
    mapped_ = queue_.enqueueMapBuffer(records_, CL_FALSE, CL_MAP_READ, 0, size * k_record_bytes, nullptr,
                                      launcher.event("readback"));
    bytes_ += shared_ ? 0 : size * k_record_bytes;
    view_ = {static_cast<const float*>(mapped_), 8, size};
  }
}

}  // namespace squall::opencl
