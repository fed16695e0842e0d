#include "backend_opencl/kernel_arguments.h"
#include "backend_opencl/sort.h"
#include "sort_bins.h"

namespace squall::opencl {

namespace {

/// Members of each bin are counted by atomics, bins get their places by a prefix sum in two levels, and each particle
/// goes behind the members of its bin that have a smaller old index (kernels/sort_bins.h).
class BinSort final : public Sort {
 public:
  BinSort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape)
      : ids_{buffers.ids[0], buffers.ids[1]},
        shape_(shape),
        tiles_(buffers.totals.getInfo<CL_MEM_SIZE>() / sizeof(cl_int)),
        groups_(buffers.group_totals.getInfo<CL_MEM_SIZE>() / sizeof(cl_int)),
        count_(program, "sort_count"),
        tile_sums_(program, "sort_sums"),
        group_sums_(program, "sort_sums"),
        starts_(program, "sort_bin_starts"),
        members_(program, "sort_members"),
        move_(program, "sort_move") {
    const auto blocks = static_cast<cl_int>(bin_blocks(shape.capacity));
    const auto tiles = static_cast<cl_int>(tiles_);
    set_arguments(count_, buffers.records, buffers.ids[0], buffers.keys, buffers.arrivals, buffers.histograms,
                  buffers.maxima, buffers.clamps, buffers.params, buffers.groups, buffers.substeps, blocks, 0, 0);
    set_arguments(tile_sums_, buffers.histograms, buffers.totals, tiles);
    set_arguments(group_sums_, buffers.totals, buffers.group_totals, static_cast<cl_int>(groups_));
    set_arguments(starts_, buffers.histograms, buffers.totals, buffers.group_totals, buffers.cell_start, tiles);
    set_arguments(members_, buffers.keys, buffers.arrivals, buffers.cell_start, buffers.members, 0);
    set_arguments(move_, buffers.records, buffers.ids[0], buffers.keys, buffers.members, buffers.cell_start,
                  buffers.sorted, buffers.ids[1], buffers.places, 0);
  }

  void enqueue(Launcher& launcher, int step, int count, int ids_from) override {
    count_.setArg(1, ids_[ids_from]);
    count_.setArg(11, step);
    count_.setArg(12, count);
    members_.setArg(4, count);
    move_.setArg(1, ids_[ids_from]);
    move_.setArg(6, ids_[1 - ids_from]);
    move_.setArg(8, count);
    run(launcher, count_, shape_.particles);
    run(launcher, tile_sums_, tiles_);
    run(launcher, group_sums_, groups_);
    run(launcher, starts_, tiles_);
    run(launcher, members_, shape_.particles);
    run(launcher, move_, shape_.particles);
  }

 private:
  void run(Launcher& launcher, const cl::Kernel& kernel, std::size_t items) const {
    launcher.run(kernel, (items + shape_.group - 1) / shape_.group * shape_.group, shape_.group, "sort");
  }

  cl::Buffer ids_[2];
  WorkShape shape_;
  std::size_t tiles_, groups_;  ///< of bins, of tiles
  cl::Kernel count_, tile_sums_, group_sums_, starts_, members_, move_;
};

}  // namespace

std::unique_ptr<Sort> make_bin_sort(const cl::Program& program, const Buffers& buffers, const WorkShape& shape) {
  return std::make_unique<BinSort>(program, buffers, shape);
}

}  // namespace squall::opencl
