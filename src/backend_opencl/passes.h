#pragma once

#include <string>

#include "backend_opencl/buffers.h"
#include "backend_opencl/launcher.h"
#include "core/scene.h"

namespace squall::opencl {

/// Options for the kernels' compiler: switches of the scene and the device; no constants.
std::string build_options(const Scene& scene, const Settings& settings, bool rounds_correctly, const WorkShape& shape);

/// Everything of a sub-step but the sort, and the summary that ends a frame. dfsph has PressureSolve in place of
/// density and forces.
class Passes {
 public:
  Passes(const cl::Program& program, const Buffers& buffers, const WorkShape& shape, Pressure pressure);

  /// Before the sort: frees held particles whose moment this is.
  void enqueue_release(Launcher& launcher, int step, int count, int ids_now);
  void enqueue_density(Launcher& launcher, int step, bool statistics);
  /// Acceleration, kick, drift, safety net.
  void enqueue_forces(Launcher& launcher, int step, int count);
  void enqueue_summary(Launcher& launcher, int count, bool statistics);

 private:
  cl::Buffer ids_[2];
  void make_force_kernels(const cl::Program& program, const Buffers& buffers);
  void make_particle_kernels(const cl::Program& program, const Buffers& buffers);
  void make_block_kernels(const cl::Program& program, const Buffers& buffers);

  WorkShape shape_;
  std::size_t pass_items_, pass_group_;  ///< of density and forces
  cl::Kernel release_, density_, density_statistics_, forces_, summary_;
};

}  // namespace squall::opencl
