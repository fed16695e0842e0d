#pragma once

#include <cstdint>
#include <vector>

#include "backend_opencl/buffers.h"
#include "backend_opencl/launcher.h"
#include "core/solver.h"

namespace squall::opencl {

/// True if the device writes right into host memory: asks it to, and looks. What the driver says about unified memory
/// is no proof.
bool shares_host_memory(Machine& machine, const cl::Program& program);

/// How positions reach the host: the read-back modes, all of them, and nothing else.
class PositionReader {
 public:
  /// `shared`: the records lie in host memory that the device writes to.
  PositionReader(Machine& machine, const cl::Program& program, const Buffers& buffers, const Layout& layout,
                 const WorkShape& shape, bool shared);
  ~PositionReader();
  PositionReader(const PositionReader&) = delete;
  PositionReader& operator=(const PositionReader&) = delete;

  static std::vector<MemoryNeed> memory_needs(const Layout& layout);

  /// Runs its kernels once, on no particles.
  void warm_up(Launcher& launcher);

  /// Takes back what the last frame delivered. Before anything else happens to the records.
  void withdraw();

  /// Blocking mode: waits for the sub-step, then reads its positions. Other modes do nothing.
  void after_substep(Launcher& launcher, int count);

  /// The other modes: enqueues what delivers the frame; the positions can be read once the queue has finished.
  void enqueue_delivery(Launcher& launcher, int count);

  /// Whether enqueue_delivery() has put something into the queue.
  bool delivers_at_end() const { return view_.count > 0 && mode_ != Readback::blocking; }

  PositionsView view() const { return view_; }

  /// Cost of delivery since the last withdraw(): what after_substep() took [ms], and bytes copied between device and
  /// host.
  double blocked_ms() const { return blocked_ms_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  void enqueue_staging(Launcher& launcher, int count);

  Readback mode_;
  bool shared_;
  WorkShape shape_;
  cl::CommandQueue queue_;
  cl::Buffer records_, staging_, pinned_;
  cl::Kernel stage_;
  std::vector<float> pageable_;
  float* pinned_memory_ = nullptr;
  void* mapped_ = nullptr;
  PositionsView view_;
  double blocked_ms_ = 0.0;
  std::uint64_t bytes_ = 0;
};

}  // namespace squall::opencl
