#include "backend_opencl/sort.h"

namespace squall::opencl {

std::unique_ptr<Sort> make_sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape) {
  return shape.lanes > 1 ? make_chunk_sort(program, buffers, shape) : make_bin_sort(program, buffers, shape);
}

}  // namespace squall::opencl
