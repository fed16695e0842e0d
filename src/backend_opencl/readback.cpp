#include "backend_opencl/readback.h"

#include <algorithm>
#include <chrono>

#include "backend_opencl/kernel_arguments.h"
#include "core/frame_plan.h"

namespace squall::opencl {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t k_record_bytes = 32;  // in single precision
constexpr std::size_t k_float4_bytes = 16;
constexpr std::size_t k_codes_bytes = 6;
constexpr float k_largest_code = k_lost_code - 1;

bool stages(const Layout& layout) {
  return layout.readback != Readback::none && !PositionReader::delivers_records(layout);
}

std::size_t staged_bytes(Readback mode) { return mode == Readback::quantized ? k_codes_bytes : k_float4_bytes; }

const char* kernel_name(Readback mode) {
  return mode == Readback::quantized ? "quantize_positions" : "stage_positions";
}

/// Pinned buffers: async fills one while the caller may still read the other.
std::size_t pinned_count(Readback mode, bool shared) {
  if (mode == Readback::async) return 2;
  return mode == Readback::pinned || (mode == Readback::quantized && !shared) ? 1 : 0;
}

std::size_t staging_bytes(const Layout& layout) {
  return std::max<std::size_t>(layout.capacity, 1) * staged_bytes(layout.readback);
}

double milliseconds(SteadyClock::time_point begin, SteadyClock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - begin).count();
}

}  // namespace

Eigen::Vector3f quantization_steps(const Params<double>& params) {
  const Params<float> p = to_single(params);
  const float top = p.lid > 0.0f ? p.size_y : p.size_y + p.lost_distance;
  return Eigen::Vector3f(p.size_x, top, p.size_z) / k_largest_code;
}

PositionReader::PositionReader(Machine& machine, const cl::Program& program, const Buffers& buffers,
                               const Layout& layout, const WorkShape& shape, bool shared)
    : mode_(layout.readback),
      stages_(stages(layout)),
      shared_(shared),
      shape_(shape),
      position_bytes_(staged_bytes(mode_)),
      steps_(quantization_steps(layout.params)),
      queue_(machine.queue),
      records_(buffers.records) {
  if (!stages_) return;
  const std::size_t bytes = staging_bytes(layout);
  if (shared_) staging_pages_ = allocate_pages(bytes);
  staging_ = cl::Buffer(machine.context, CL_MEM_READ_WRITE | (staging_pages_ ? CL_MEM_USE_HOST_PTR : 0), bytes,
                        staging_pages_.get());
  kernel_ = cl::Kernel(program, kernel_name(mode_));
  if (mode_ == Readback::quantized) {
    const Eigen::Vector3f inverse = steps_.cwiseInverse();
    set_arguments(kernel_, records_, staging_, cl_float4{{inverse.x(), inverse.y(), inverse.z(), 0.0f}}, 0);
  } else {
    set_arguments(kernel_, records_, staging_, 0);
  }
  if (mode_ == Readback::blocking) pageable_.resize(bytes / sizeof(float));
  for (std::size_t i = 0; i < pinned_count(mode_, shared_); ++i)
    pinned_.push_back(std::make_unique<PinnedMemory>(machine, bytes));
  if (mode_ == Readback::async)
    copy_queue_ = cl::CommandQueue(machine.context, machine.device, machine.queue.getInfo<CL_QUEUE_PROPERTIES>());
}

PositionReader::~PositionReader() {
  try {
    withdraw();
    queue_.finish();
  } catch (const cl::Error&) {
    // The device is gone, and its memory with it.
  }
}

std::vector<MemoryNeed> PositionReader::memory_needs(const Layout& layout) {
  std::vector<MemoryNeed> needs;
  if (stages(layout)) needs.push_back({"staged positions", staging_bytes(layout)});
  for (std::size_t i = 0; i < pinned_count(layout.readback, false); ++i)
    needs.push_back({"pinned positions", staging_bytes(layout)});
  return needs;
}

void PositionReader::warm_up(Launcher& launcher) {
  if (stages_) run_kernel(launcher, 0);
}

void PositionReader::withdraw() {
  view_ = {};
  blocked_ms_ = 0.0;
  copied_bytes_ = 0;
  delivered_ = {};
  copied_.reset();
  staged_.clear();
  staged_count_ = 0;
  if (copy_queue_()) copy_queue_.finish();
  if (!mapped_) return;
  queue_.enqueueUnmapMemObject(*mapped_buffer_, mapped_);
  mapped_ = nullptr;
}

void PositionReader::before_frame(Launcher& launcher, int count) {
  if (mode_ != Readback::async || count == 0) return;
  staged_count_ = static_cast<std::size_t>(count);
  staged_ = {run_kernel(launcher, staged_count_)};
}

void PositionReader::after_substep(Launcher& launcher, int count) {
  if (mode_ == Readback::async && staged_count_ > 0) send_staged(launcher);
  if (mode_ == Readback::blocking && count > 0) read_and_wait(launcher, static_cast<std::size_t>(count));
}

/// Once the device has the sub-step to compute beside it.
void PositionReader::send_staged(Launcher& launcher) {
  queue_.flush();
  turn_ = (turn_ + 1) % pinned_.size();
  read(launcher, copy_queue_, pinned_[turn_]->data(), staged_count_, &staged_);
  copy_queue_.flush();
  copied_.emplace(delivered_);
  show(pinned_[turn_]->data(), staged_count_);
  staged_count_ = 0;
}

void PositionReader::read_and_wait(Launcher& launcher, std::size_t count) {
  const auto waited_from = SteadyClock::now();
  queue_.finish();
  launcher.trace().finished();
  launcher.trace().host("wait", waited_from);
  const auto begin = SteadyClock::now();
  run_kernel(launcher, count);
  read(launcher, queue_, pageable_.data(), count, nullptr);
  wait_for(delivered_, "reading positions after a sub-step");
  launcher.trace().finished();
  launcher.trace().host("read-back", begin);
  blocked_ms_ += milliseconds(begin, SteadyClock::now());
  show(pageable_.data(), count);
}

void PositionReader::after_frame(Launcher& launcher, int count) {
  if (count == 0) return;
  const auto size = static_cast<std::size_t>(count);
  if (mode_ == Readback::mapped && !stages_) {
    map(launcher, records_, size * k_record_bytes);
  } else if (mode_ == Readback::pinned || mode_ == Readback::mapped || mode_ == Readback::quantized) {
    run_kernel(launcher, size);
    if (mode_ == Readback::mapped || (mode_ == Readback::quantized && shared_)) {
      map(launcher, staging_, size * position_bytes_);
    } else {
      read(launcher, queue_, pinned_.front()->data(), size, nullptr);
      show(pinned_.front()->data(), size);
    }
  }
  if (mapped_) show(mapped_, size);
}

double PositionReader::finish(Launcher& launcher, const Completion& computed) {
  if (view_.count == 0 || mode_ == Readback::blocking) return blocked_ms_;
  wait_for(delivered_, "delivering positions");
  const auto now = SteadyClock::now();
  launcher.trace().finished(lane());
  const auto begin = computed.time(now);
  if (copied_ && copied_->time(now) <= begin) return 0.0;
  return milliseconds(begin, now);
}

cl::Event PositionReader::run_kernel(Launcher& launcher, std::size_t count) {
  cl::Event staged;
  const auto asked = SteadyClock::now();
  kernel_.setArg(mode_ == Readback::quantized ? 3 : 2, static_cast<int>(count));
  queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(shape_.particles), cl::NDRange(shape_.group), nullptr,
                              &staged);
  launcher.note(staged, k_readback_phase, {kernel_name(mode_), CommandTrace::k_queue, asked});
  copied_bytes_ += count * position_bytes_;
  return staged;
}

void PositionReader::read(Launcher& launcher, cl::CommandQueue& queue, void* to, std::size_t count,
                          const std::vector<cl::Event>* after) {
  const std::size_t bytes = count * position_bytes_;
  const auto asked = SteadyClock::now();
  queue.enqueueReadBuffer(staging_, CL_FALSE, 0, bytes, to, after, &delivered_);
  launcher.note(delivered_, k_readback_phase, {k_readback_phase, lane(), asked});
  copied_bytes_ += bytes;
}

void PositionReader::map(Launcher& launcher, const cl::Buffer& buffer, std::size_t bytes) {
  const auto asked = SteadyClock::now();
  mapped_ = queue_.enqueueMapBuffer(buffer, CL_FALSE, CL_MAP_READ, 0, bytes, nullptr, &delivered_);
  mapped_buffer_ = &buffer;
  launcher.note(delivered_, k_readback_phase, {k_readback_phase, lane(), asked});
  copied_bytes_ += shared_ ? 0 : bytes;
}

void PositionReader::show(const void* data, std::size_t count) {
  const bool coded = mode_ == Readback::quantized;
  view_.data = data;
  view_.format = coded ? PositionFormat::unorm16 : PositionFormat::float32;
  view_.stride = stages_ ? position_bytes_ : k_record_bytes;
  view_.count = count;
  if (coded) view_.scale = steps_;
}

}  // namespace squall::opencl
