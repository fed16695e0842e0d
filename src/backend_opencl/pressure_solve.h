#pragma once

#include "backend_opencl/buffers.h"
#include "backend_opencl/launcher.h"
#include "core/frame_report.h"
#include "core/scene.h"
#include "solve_state.h"

namespace squall::opencl {

/// dfsph on the device, drift included (docs/dfsph.md). Which iteration is the last, kernels decide; the host enqueues
/// as many as it expects, and what comes next, and looks whether that was enough. How many it enqueues at a time
/// changes no bit.
class PressureSolve {
 public:
  PressureSolve(const cl::Program& program, const Buffers& buffers, const WorkShape& shape,
                const Scene::Solver& settings);

  /// Runs every kernel once, on no particles.
  void warm_up(Launcher& launcher);

  /// A sub-step from after the sort to the end. Returns when both solves are over. Counts iterations in the report.
  void run(Launcher& launcher, int step, int count, FrameReport& report);

 private:
  /// One of the two solves.
  struct Solve {  // NOLINT(bugprone-exception-escape): what opencl.hpp does as it moves
    const char* phase;
    cl::Kernel rate, sums, decide, push;
    int expected = 1;  ///< iterations to enqueue at first
  };

  void make_particle_kernels(const cl::Program& program, const Buffers& buffers);
  void make_block_kernels(const cl::Program& program, const Buffers& buffers);
  Solve make_solve(const cl::Program& program, const Buffers& buffers, int which) const;
  void set_step(int step, int count);
  void begin(Launcher& launcher);
  void iterate(Launcher& launcher, Solve& solve, int iterations);
  void look(Launcher& launcher);
  void note(FrameReport& report);

  WorkShape shape_;
  Scene::Solver settings_;
  cl::Buffer state_;
  std::size_t items_, group_;  ///< of the passes over particles
  cl_int stride_;              ///< from one field of the solves to the next
  cl::Kernel prepare_, excess_sums_, begin_, predict_, drift_;
  Solve solves_[2];    ///< SQUALL_DIVERGENCE_SOLVE, SQUALL_DENSITY_SOLVE
  SolveState seen_{};  ///< when the host looked last
};

}  // namespace squall::opencl
