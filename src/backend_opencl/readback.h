#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "backend_opencl/buffers.h"
#include "backend_opencl/completion.h"
#include "backend_opencl/launcher.h"
#include "backend_opencl/pinned_memory.h"
#include "core/solver.h"

namespace squall::opencl {

/// Metres per code of Readback::quantized, so that the whole of where particles can be has a code: the container, and
/// without a lid the lost distance above it.
Eigen::Vector3f quantization_steps(const Params<double>& params);

/// How positions reach the host: the read-back modes, all of them, and nothing else (docs/readback.md). After finish()
/// no command of any mode is in flight.
class PositionReader {
 public:
  /// `shared`: the device writes to host memory; the records lie there.
  PositionReader(Machine& machine, const cl::Program& program, const Buffers& buffers, const Layout& layout,
                 const WorkShape& shape, bool shared);
  ~PositionReader();
  PositionReader(const PositionReader&) = delete;
  PositionReader& operator=(const PositionReader&) = delete;

  /// Whether it matters to a mode that device and host share memory.
  static bool wants_shared(Readback mode) { return mode == Readback::mapped || mode == Readback::quantized; }
  /// Whether the records themselves are delivered: positions are delivered in single precision.
  static bool delivers_records(const Layout& layout) {
    return layout.readback == Readback::mapped && !layout.is_double();
  }
  static std::vector<MemoryNeed> memory_needs(const Layout& layout);

  /// Runs its kernels once, on no particles.
  void warm_up(Launcher& launcher);

  /// Takes back what the last frame delivered, and waits for what a frame that failed may have left in flight. Before
  /// anything else happens to the records.
  void withdraw();

  /// Before the sub-steps, with the particles that the last frame ended with. async: takes a snapshot of them.
  void before_frame(Launcher& launcher, int count);

  /// async, the first time: sends the snapshot. blocking: waits for the sub-step, then reads its positions.
  void after_substep(Launcher& launcher, int count);

  /// The other modes: enqueues what delivers the frame.
  void after_frame(Launcher& launcher, int count);

  /// Waits until the positions can be read; `computed` is when the frame's last result was there. Returns what reading
  /// back cost after that, or between sub-steps [ms]. Throws cl::Error if a transfer failed.
  double finish(Launcher& launcher, const Completion& computed);

  PositionsView view() const { return view_; }

  /// Bytes written to deliver since the last withdraw(): by kernels that write positions for the host, and by
  /// transfers.
  std::uint64_t copied_bytes() const { return copied_bytes_; }
  int latency_frames() const { return mode_ == Readback::async ? 1 : 0; }

 private:
  /// The trace's, of the queue that delivers.
  const char* lane() const { return mode_ == Readback::async ? CommandTrace::k_transfer_queue : CommandTrace::k_queue; }
  cl::Event run_kernel(Launcher& launcher, std::size_t count);
  void read(Launcher& launcher, cl::CommandQueue& queue, void* to, std::size_t count,
            const std::vector<cl::Event>* after);
  void send_staged(Launcher& launcher);
  void read_and_wait(Launcher& launcher, std::size_t count);
  void map(Launcher& launcher, const cl::Buffer& buffer, std::size_t bytes);
  void show(const void* data, std::size_t count);

  Readback mode_;
  bool stages_;  ///< by its kernel: into `staging_`
  bool shared_;
  WorkShape shape_;
  std::size_t position_bytes_;  ///< in `staging_`
  Eigen::Vector3f steps_;       ///< m, quantized
  cl::CommandQueue queue_, copy_queue_;
  cl::Buffer records_, staging_;
  cl::Kernel kernel_;                                  ///< from records to `staging_`
  Pages staging_pages_;                                ///< where `staging_` lies, if the host shares it
  std::vector<float> pageable_;                        ///< blocking
  std::vector<std::unique_ptr<PinnedMemory>> pinned_;  ///< take turns
  std::size_t turn_ = 0;
  const cl::Buffer* mapped_buffer_ = nullptr;
  void* mapped_ = nullptr;
  std::vector<cl::Event> staged_;     ///< async: the snapshot
  std::size_t staged_count_ = 0;      ///< async: of a snapshot not yet sent
  cl::Event delivered_;               ///< last command of the delivery
  std::optional<Completion> copied_;  ///< async: when that was
  PositionsView view_;
  double blocked_ms_ = 0.0;  ///< what after_substep() took
  std::uint64_t copied_bytes_ = 0;
};

}  // namespace squall::opencl
