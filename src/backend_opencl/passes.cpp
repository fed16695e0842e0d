#include "backend_opencl/passes.h"

#include "backend_opencl/kernel_arguments.h"

namespace squall::opencl {

std::string build_options(const Scene& scene, const Settings& settings, bool rounds_correctly, const WorkShape& shape) {
  const Pressure pressure = settings.pressure;
  const bool is_double = settings.precision == Precision::double_precision;
  const auto flag = [](const char* name, bool value) { return std::string(" -D") + name + (value ? "=1" : "=0"); };
  std::string options = "-cl-std=CL1.2";
  if (rounds_correctly) options += " -cl-fp32-correctly-rounded-divide-sqrt";
  return options + " -DSQUALL_LANES=" + std::to_string(shape.lanes) + flag("SQUALL_DOUBLE", is_double) +
         flag("SQUALL_WCSPH", pressure != Pressure::mueller) + flag("SQUALL_DFSPH", pressure == Pressure::dfsph) +
         flag("SQUALL_WEIGHTS", shape.weights) + flag("SQUALL_SMOOTHING", scene.solver.xsph > 0.0) +
         flag("SQUALL_VISCOSITY", scene.fluid.viscosity_m2_s.has_value()) + flag("SQUALL_BOXES", !scene.boxes.empty()) +
         flag("SQUALL_DRAG", !scene.rains.empty());
}

Passes::Passes(const cl::Program& program, const Buffers& buffers, const WorkShape& shape, Pressure pressure)
    : ids_{buffers.ids[0], buffers.ids[1]},
      shape_(shape),
      pass_items_(shape.lanes == 1 ? shape.particles : shape.parts),
      pass_group_(shape.lanes == 1 ? shape.group : 1),
      release_(program, "release"),
      summary_(program, "summary") {
  if (pressure != Pressure::dfsph) make_force_kernels(program, buffers);
  set_arguments(release_, buffers.records, buffers.ids[0], buffers.params, buffers.groups, buffers.substeps, 0, 0);
  set_arguments(summary_, buffers.records, buffers.densities, buffers.neighbours, buffers.cell_start, buffers.maxima,
                buffers.clamps, buffers.params, 0, 0, buffers.summaries);
}

void Passes::make_force_kernels(const cl::Program& program, const Buffers& buffers) {
  if (shape_.lanes == 1)
    make_particle_kernels(program, buffers);
  else
    make_block_kernels(program, buffers);
}

void Passes::make_particle_kernels(const cl::Program& program, const Buffers& buffers) {
  density_ = cl::Kernel(program, "density");
  density_statistics_ = cl::Kernel(program, "density_statistics");
  forces_ = cl::Kernel(program, "forces");
  set_arguments(density_, buffers.places, buffers.sorted, buffers.densities, buffers.isolations, buffers.cell_start,
                buffers.params, buffers.boxes, buffers.substeps, 0);
  set_arguments(density_statistics_, buffers.places, buffers.sorted, buffers.densities, buffers.isolations,
                buffers.cell_start, buffers.params, buffers.boxes, buffers.substeps, 0, buffers.neighbours);
  set_arguments(forces_, buffers.sorted, buffers.records, buffers.densities, buffers.isolations, buffers.cell_start,
                buffers.clamps, buffers.params, buffers.boxes, buffers.substeps, 0, 0);
}

void Passes::make_block_kernels(const cl::Program& program, const Buffers& buffers) {
  density_ = cl::Kernel(program, "density_blocks");
  forces_ = cl::Kernel(program, "forces_blocks");
  set_arguments(density_, buffers.sorted, buffers.densities, buffers.isolations, buffers.neighbours, buffers.x,
                buffers.y, buffers.z, buffers.cell_start, buffers.lists, buffers.params, buffers.boxes,
                buffers.substeps, 0);
  set_arguments(forces_, buffers.sorted, buffers.records, buffers.densities, buffers.isolations, buffers.x, buffers.y,
                buffers.z, buffers.cell_start, buffers.lists, buffers.clamps, buffers.params, buffers.boxes,
                buffers.substeps, 0, 0);
  density_statistics_ = density_;  // it looks at the table itself
}

void Passes::enqueue_release(Launcher& launcher, int step, int count, int ids_now) {
  release_.setArg(1, ids_[ids_now]);
  release_.setArg(5, step);
  release_.setArg(6, count);
  launcher.run(release_, shape_.particles, shape_.group, "release");
}

void Passes::enqueue_density(Launcher& launcher, int step, bool statistics) {
  cl::Kernel& kernel = statistics ? density_statistics_ : density_;
  kernel.setArg(shape_.lanes == 1 ? 8 : 12, step);
  launcher.run(kernel, pass_items_, pass_group_, "density");
}

void Passes::enqueue_forces(Launcher& launcher, int step, int count) {
  const cl_uint first = shape_.lanes == 1 ? 9 : 13;
  forces_.setArg(first, step);
  forces_.setArg(first + 1, count);
  launcher.run(forces_, pass_items_, pass_group_, "forces");
}

void Passes::enqueue_summary(Launcher& launcher, int count, bool statistics) {
  summary_.setArg(7, statistics ? 1 : 0);
  summary_.setArg(8, count);
  launcher.run(summary_, shape_.chunks, shape_.chunk_group, "summary");
}

}  // namespace squall::opencl
