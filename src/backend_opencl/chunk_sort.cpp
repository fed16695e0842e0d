#include "backend_opencl/kernel_arguments.h"
#include "backend_opencl/sort.h"

namespace squall::opencl {

namespace {

/// A counting sort: a histogram per chunk, one prefix sum over cells and chunks, and a scatter that keeps each chunk's
/// order.
class ChunkSort final : public Sort {
 public:
  ChunkSort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape)
      : ids_{buffers.ids[0], buffers.ids[1]},
        shape_(shape),
        histogram_(program, "sort_histogram"),
        totals_(program, "sort_totals"),
        starts_(program, "sort_starts"),
        scatter_(program, "sort_scatter") {
    const auto chunks = static_cast<cl_int>(shape.chunks);
    set_arguments(histogram_, buffers.records, buffers.ids[0], buffers.keys, buffers.histograms, buffers.maxima,
                  buffers.clamps, buffers.params, buffers.groups, buffers.substeps, 0, 0);
    set_arguments(totals_, buffers.histograms, buffers.totals, buffers.params, chunks);
    set_arguments(starts_, buffers.histograms, buffers.totals, buffers.cell_start, buffers.params, chunks);
    set_arguments(scatter_, buffers.records, buffers.ids[0], buffers.keys, buffers.histograms, buffers.sorted,
                  buffers.ids[1], buffers.x, buffers.y, buffers.z, buffers.params, 0);
  }

  void enqueue(Launcher& launcher, int step, int count, int ids_from) override {
    histogram_.setArg(1, ids_[ids_from]);
    histogram_.setArg(9, step);
    histogram_.setArg(10, count);
    scatter_.setArg(1, ids_[ids_from]);
    scatter_.setArg(5, ids_[1 - ids_from]);
    scatter_.setArg(10, count);
    launcher.run(histogram_, shape_.chunks, shape_.chunk_group, "sort");
    launcher.run(totals_, shape_.ranges, shape_.chunk_group, "sort");
    launcher.run(starts_, shape_.ranges, shape_.chunk_group, "sort");
    launcher.run(scatter_, shape_.chunks, shape_.chunk_group, "sort");
  }

 private:
  cl::Buffer ids_[2];
  WorkShape shape_;
  cl::Kernel histogram_, totals_, starts_, scatter_;
};

}  // namespace

std::unique_ptr<Sort> make_chunk_sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape) {
  return std::make_unique<ChunkSort>(program, buffers, shape);
}

}  // namespace squall::opencl
