#pragma once

#include "backend_opencl/buffers.h"
#include "backend_opencl/launcher.h"

namespace squall::opencl {

/// The stable counting sort by cell, all on the device: a histogram per chunk, one prefix sum over cells and chunks,
/// and a scatter that keeps each chunk's order.
class Sort {
 public:
  Sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape);

  /// Sorts `count` records and the ids in buffers.ids[ids_from] into buffers.sorted and the other ids.
  void enqueue(Launcher& launcher, int step, int count, int ids_from);

 private:
  cl::Buffer ids_[2];
  WorkShape shape_;
  cl::Kernel histogram_, totals_, starts_, scatter_;
};

}  // namespace squall::opencl
