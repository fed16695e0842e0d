#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "backend_opencl/device.h"
#include "core/settings.h"
#include "params.h"

namespace squall::opencl {

/// What a solver knows before it allocates.
struct Layout {
  Params<double> params;
  std::vector<Box<double>> boxes;
  std::vector<HeldGroup> groups;
  std::size_t capacity = 0;  ///< particles
  bool drag = false;
  bool statistics = false;
  bool dfsph = false;
  Readback readback = Readback::none;
  WorkSizes work;
  Precision precision = Precision::single_precision;  ///< of everything on the device but delivered positions
  /// Lanes: scalar 1, avx2 8, avx512 16, and half as many in double precision; best: by the device.
  Simd simd = Simd::best;

  bool is_double() const { return precision == Precision::double_precision; }
  std::size_t scalar_bytes() const { return is_double() ? sizeof(double) : sizeof(float); }
  std::size_t record_bytes() const { return 8 * scalar_bytes(); }
};

/// How work is cut into work-items. Fixed for a run, so that a compiler that specialises kernels by shape meets each
/// shape once, before the first frame.
struct WorkShape {
  std::size_t capacity = 0;   ///< particles there is room for
  std::size_t particles = 0;  ///< work-items, one for each of them, in groups of `group`
  std::size_t group = 64;
  std::size_t chunks = 1;  ///< of particles, where order matters or a sum is made
  std::size_t ranges = 1;  ///< of cells, where the sort goes by chunks
  std::size_t chunk_group = 1;
  int lanes = 1;              ///< particles per vector: 1 gives every particle a work-item of its own, sort included
  std::size_t parts = 1;      ///< work-items over rows of cells, with more lanes than one
  std::size_t sum_group = 1;  ///< of work-items that sum up what dfsph goes on by, with one lane
  bool weights = false;       ///< dfsph, with more lanes than one: keeps weights of pairs
};
/// With weights wherever dfsph may keep them, whether there is room or not. Throws InputError for work sizes that are
/// out of range, or too large for the device.
WorkShape make_shape(const Machine& machine, const Layout& layout);

/// Shares of the sums that dfsph goes on by.
std::size_t share_count(const WorkShape& shape);
/// From one field of what dfsph keeps of particles to the next (solve_state.h).
std::size_t solve_stride(const WorkShape& shape);

/// Memory aligned to pages, for buffers that a device shares with the host.
struct PageDeleter {
  void operator()(std::byte* memory) const;
};
using Pages = std::unique_ptr<std::byte[], PageDeleter>;
Pages allocate_pages(std::size_t bytes);

/// Everything on the device. A record is eight numbers: {x, y, z, spare, vx, vy, vz, spare}.
// NOLINTNEXTLINE(bugprone-exception-escape,bugprone-reserved-identifier): what opencl.hpp and the compiler do as it
// moves
struct Buffers {
  cl::Buffer records;                ///< between sub-steps, in the order of the last sort
  cl::Buffer sorted;                 ///< within a sub-step
  cl::Buffer ids[2];                 ///< take turns: the sort reads one and writes the other
  cl::Buffer keys;                   ///< cell, or bin (sort_bins.h), of each particle
  cl::Buffer histograms;             ///< per chunk: particles per cell, then where they go; or members of each bin
  cl::Buffer totals;                 ///< particles per range of cells, or per tile of bins
  cl::Buffer group_totals;           ///< particles per group of tiles
  cl::Buffer arrivals, members;      ///< sort_count.cl, sort_members.cl
  cl::Buffer cell_start;             ///< cells, then held and lost particles, in one bin each or in several
  cl::Buffer places;                 ///< positions in sorted order, for kernels with a work-item per particle
  cl::Buffer densities, isolations;  ///< in sorted order
  cl::Buffer neighbours;             ///< likewise
  cl::Buffer x, y, z;                ///< likewise, for kernels that work on blocks
  cl::Buffer lists;                  ///< likewise: neighbours of blocks
  cl::Buffer weights;                ///< dfsph: of their pairs, a vector of lanes for each entry of the lists
  cl::Buffer solve;                  ///< dfsph: fields of all particles, in sorted order (solve_state.h)
  cl::Buffer errors;                 ///< dfsph: likewise, for kernels with a work-item per particle
  cl::Buffer shares;                 ///< dfsph: of the sums that decide
  cl::Buffer solve_state;            ///< dfsph
  cl::Buffer maxima;                 ///< per chunk or per index: |v|^2 and |a|^2 of the frame so far
  cl::Buffer clamps;                 ///< of the frame
  cl::Buffer summaries;              ///< per chunk, at the end of a frame
  cl::Buffer substeps;               ///< the frame's table
  cl::Buffer params, boxes, groups;  ///< constants
  Pages record_pages;                ///< where `records` lies, if the host shares it
};

/// Sizes of all buffers, for check_limits.
std::vector<MemoryNeed> memory_needs(const Layout& layout, const WorkShape& shape);

/// Allocates, and uploads the constants. `share_records` puts the records into host memory.
Buffers make_buffers(Machine& machine, const Layout& layout, const WorkShape& shape, bool share_records);

}  // namespace squall::opencl
