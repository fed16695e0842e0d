#pragma once

#include <memory>

#include "backend_opencl/buffers.h"
#include "backend_opencl/launcher.h"

namespace squall::opencl {

/// The stable sort by cell, all on the device and without a wait.
class Sort {
 public:
  virtual ~Sort() = default;

  /// Sorts `count` records and the ids in buffers.ids[ids_from] into buffers.sorted and the other ids.
  virtual void enqueue(Launcher& launcher, int step, int count, int ids_from) = 0;
};

/// By the shape's lanes: with vectors of particles, few work-items that each keep the order of a chunk
/// (chunk_sort.cpp); with one, a work-item per particle (bin_sort.cpp). The order is the same.
std::unique_ptr<Sort> make_sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape);

/// What make_sort() chooses from.
std::unique_ptr<Sort> make_chunk_sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape);
std::unique_ptr<Sort> make_bin_sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape);

}  // namespace squall::opencl
