#include "backend_opencl/pressure_solve.h"

#include <algorithm>
#include <chrono>

#include "backend_opencl/completion.h"
#include "backend_opencl/kernel_arguments.h"
#include "core/convergence.h"

namespace squall::opencl {

namespace {

constexpr int k_most_at_once = 16;  ///< iterations enqueued before the host looks
constexpr int k_spare = 1;          ///< iterations of the density solve beyond those of the sub-step before

/// Indices of the arguments that change from sub-step to sub-step; `particles` and `blocks` are the two shapes'.
cl_uint either(const WorkShape& shape, cl_uint particles, cl_uint blocks) {
  return shape.lanes == 1 ? particles : blocks;
}

}  // namespace

PressureSolve::PressureSolve(const cl::Program& program, const Buffers& buffers, const WorkShape& shape,
                             const Scene::Solver& settings)
    : shape_(shape),
      settings_(settings),
      state_(buffers.solve_state),
      items_(shape.lanes == 1 ? shape.particles : shape.parts),
      group_(shape.lanes == 1 ? shape.group : 1),
      stride_(static_cast<cl_int>(solve_stride(shape))),
      begin_(program, "solve_begin") {
  if (shape.lanes == 1)
    make_particle_kernels(program, buffers);
  else
    make_block_kernels(program, buffers);
  set_arguments(begin_, state_, buffers.shares, static_cast<cl_int>(share_count(shape)), buffers.cell_start,
                buffers.params, buffers.substeps, 0);
  for (const int which : {SQUALL_DIVERGENCE_SOLVE, SQUALL_DENSITY_SOLVE})
    solves_[which] = make_solve(program, buffers, which);
  solves_[SQUALL_DENSITY_SOLVE].expected = 2;
}

void PressureSolve::make_particle_kernels(const cl::Program& program, const Buffers& b) {
  prepare_ = cl::Kernel(program, "prepare");
  excess_sums_ = cl::Kernel(program, "solve_sums");
  predict_ = cl::Kernel(program, "predict");
  drift_ = cl::Kernel(program, "drift");
  set_arguments(prepare_, b.places, b.sorted, b.densities, b.isolations, b.neighbours, b.cell_start, b.solve, b.errors,
                b.params, b.boxes, b.substeps, stride_, 0);
  set_arguments(excess_sums_, b.errors, b.cell_start, state_, b.shares, b.params, -1);
  set_arguments(predict_, b.places, b.sorted, b.records, b.densities, b.isolations, b.cell_start, b.solve, state_,
                b.params, b.substeps, stride_, 0, 0);
  set_arguments(drift_, b.records, b.cell_start, b.solve, b.clamps, state_, b.params, b.boxes, b.substeps, stride_, 0,
                0);
}

void PressureSolve::make_block_kernels(const cl::Program& program, const Buffers& b) {
  prepare_ = cl::Kernel(program, "prepare_blocks");
  predict_ = cl::Kernel(program, "predict_blocks");
  drift_ = cl::Kernel(program, "drift_blocks");
  set_arguments(prepare_, b.sorted, b.densities, b.isolations, b.neighbours, b.x, b.y, b.z, b.cell_start, b.lists,
                b.weights, b.solve, b.shares, b.params, b.boxes, b.substeps, stride_, 0);
  set_arguments(predict_, b.sorted, b.records, b.densities, b.isolations, b.x, b.y, b.z, b.cell_start, b.lists,
                b.weights, b.solve, state_, b.params, b.substeps, stride_, 0, 0);
  set_arguments(drift_, b.records, b.x, b.y, b.z, b.cell_start, b.solve, b.clamps, state_, b.params, b.boxes,
                b.substeps, stride_, 0, 0);
}

PressureSolve::Solve PressureSolve::make_solve(const cl::Program& program, const Buffers& b, int which) const {
  const bool density = which == SQUALL_DENSITY_SOLVE;
  const cl::Buffer& records = density ? b.records : b.sorted;
  const cl_int least = density ? 2 : 1, most = settings_.max_iterations;
  const cl_long unit = convergence_limit(density ? settings_.density_tolerance : settings_.divergence_tolerance, 1);
  Solve solve;
  solve.phase = density ? "density solve" : "divergence solve";
  solve.decide = cl::Kernel(program, "solve_decide");
  set_arguments(solve.decide, state_, b.shares, static_cast<cl_int>(share_count(shape_)), b.cell_start, b.params, unit,
                least, most, which);
  if (shape_.lanes == 1) {
    solve.rate = cl::Kernel(program, "rate");
    solve.sums = cl::Kernel(program, "solve_sums");
    solve.push = cl::Kernel(program, "push");
    set_arguments(solve.rate, b.places, records, b.cell_start, b.solve, b.errors, state_, b.params, b.substeps, stride_,
                  0, which);
    set_arguments(solve.sums, b.errors, b.cell_start, state_, b.shares, b.params, which);
    set_arguments(solve.push, records, b.cell_start, b.solve, state_, b.params, stride_, which);
  } else {
    solve.rate = cl::Kernel(program, "rate_blocks");
    solve.push = cl::Kernel(program, "push_blocks");
    set_arguments(solve.rate, records, b.x, b.y, b.z, b.cell_start, b.lists, b.weights, b.solve, b.shares, state_,
                  b.params, b.substeps, stride_, 0, which);
    set_arguments(solve.push, records, b.x, b.y, b.z, b.cell_start, b.lists, b.weights, b.solve, state_, b.params,
                  stride_, which);
  }
  return solve;
}

void PressureSolve::set_step(int step, int count) {
  prepare_.setArg(either(shape_, 12, 16), step);
  begin_.setArg(6, step);
  for (auto& solve : solves_) solve.rate.setArg(either(shape_, 9, 13), step);
  predict_.setArg(either(shape_, 11, 15), step);
  predict_.setArg(either(shape_, 12, 16), count);
  drift_.setArg(either(shape_, 9, 12), step);
  drift_.setArg(either(shape_, 10, 13), count);
}

void PressureSolve::begin(Launcher& launcher) {
  launcher.run(prepare_, items_, group_, "prepare");
  if (shape_.lanes == 1) launcher.run(excess_sums_, share_count(shape_), shape_.sum_group, "prepare");
  launcher.run(begin_, 1, 1, "prepare");
}

void PressureSolve::iterate(Launcher& launcher, Solve& solve, int iterations) {
  for (int iteration = 0; iteration < iterations; ++iteration) {
    launcher.run(solve.rate, items_, group_, solve.phase);
    if (shape_.lanes == 1) launcher.run(solve.sums, share_count(shape_), shape_.sum_group, solve.phase);
    launcher.run(solve.decide, 1, 1, solve.phase);
    launcher.run(solve.push, items_, group_, solve.phase);
  }
}

/// Enqueues the drift behind the look, so that the device has something to do meanwhile; it does nothing before both
/// solves are over.
void PressureSolve::look(Launcher& launcher) {
  cl::Event read;
  const auto asked = std::chrono::steady_clock::now();
  launcher.queue().enqueueReadBuffer(state_, CL_FALSE, 0, sizeof seen_, &seen_, nullptr, &read);
  launcher.note(read, "density solve", {"read solve state", CommandTrace::k_queue, asked});
  launcher.run(drift_, items_, group_, "drift");
  launcher.queue().flush();
  wait_for(read, "solving for pressure");
}

void PressureSolve::run(Launcher& launcher, int step, int count, FrameReport& report) {
  set_step(step, count);
  begin(launcher);
  seen_ = {};
  int enqueued[2] = {solves_[0].expected, solves_[1].expected};
  while (seen_.solve != SQUALL_SOLVED) {
    for (int& iterations : enqueued)
      iterations = std::clamp(iterations, 1, std::min(k_most_at_once, settings_.max_iterations));
    if (seen_.solve == SQUALL_DIVERGENCE_SOLVE) {
      iterate(launcher, solves_[SQUALL_DIVERGENCE_SOLVE], enqueued[0]);
      launcher.run(predict_, items_, group_, "predict");
    }
    iterate(launcher, solves_[SQUALL_DENSITY_SOLVE], enqueued[1]);
    look(launcher);
    enqueued[seen_.solve == SQUALL_DIVERGENCE_SOLVE ? 0 : 1] *= 2;  // it was not enough
  }
  note(report);
}

void PressureSolve::note(FrameReport& report) {
  const auto [divergence, density] = seen_.iterations;
  solves_[SQUALL_DIVERGENCE_SOLVE].expected = divergence;
  solves_[SQUALL_DENSITY_SOLVE].expected = density + k_spare;
  report.divergence_iterations += divergence;
  report.density_iterations += density;
  report.divergence_iterations_max = std::max(report.divergence_iterations_max, divergence);
  report.density_iterations_max = std::max(report.density_iterations_max, density);
  report.unconverged += seen_.unconverged;
}

void PressureSolve::warm_up(Launcher& launcher) {
  FrameReport none;
  run(launcher, 0, 0, none);
}

}  // namespace squall::opencl
