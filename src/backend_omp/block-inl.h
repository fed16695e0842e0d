#pragma once

// Included once per instruction set and precision, after its Pack. Nothing here has external linkage: code compiled for
// one instruction set must not be picked by the linker for another.

#include <cstddef>
#include <cstdint>

#include "backend_omp/passes.h"
#include "boundary.h"
#include "grid.h"
#include "walls.h"

namespace squall::openmp {

namespace {

#if defined(__GNUC__)
#define SQUALL_NOINLINE __attribute__((noinline))
#else
#define SQUALL_NOINLINE
#endif

/// Asks for the cache line `ahead` values further on, which may lie behind the end: nothing is read.
SQUALL_INLINE void prefetch([[maybe_unused]] const Scalar* from, [[maybe_unused]] std::size_t ahead) {
#if defined(__GNUC__)
  // NOLINTNEXTLINE(performance-no-int-to-ptr): a pointer may not point there
  __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(from) + ahead * sizeof(Scalar)));
#endif
}

/// Up to Pack::k_lanes consecutive particles of one row of cells, one per lane.
struct Block {
  int begin, end;  ///< sorted indices
  int row, cell_y, cell_z;
  int count() const { return end - begin; }
};

/// The block's part of an array with a value per sorted particle.
template <class Pack>
void store_lanes(Scalar* values, const Block& block, Pack value) {
  if (block.count() == Pack::k_lanes) {
    value.store(values + block.begin);
    return;
  }
  alignas(64) Scalar lanes[Pack::k_lanes];
  value.store(lanes);
  for (int lane = 0; lane < block.count(); ++lane) values[block.begin + lane] = lanes[lane];
}

/// Calls visit(block) for every block of the rows, in sorted order.
template <class Pack, class Visit>
void for_each_block(const PassContext<Scalar>& context, int first_row, int end_row, Visit visit) {
  const Params<Scalar>& p = *context.params;
  for (int row = first_row; row < end_row; ++row) {
    const int end = context.cell_start[(row + 1) * p.cells_x];
    for (int begin = context.cell_start[row * p.cells_x]; begin < end; begin += Pack::k_lanes) {
      const int block_end = begin + Pack::k_lanes < end ? begin + Pack::k_lanes : end;
      visit(Block{begin, block_end, row, row % p.cells_y, row / p.cells_y});
    }
  }
}

/// The candidates of a block: at most nine ranges, in canonical order. Returns how many; adds up their length in
/// `total`.
inline int candidate_ranges(const PassContext<Scalar>& context, const Block& block, Range* ranges, int& total) {
  const Params<Scalar>& p = *context.params;
  const int low = cell_coordinate(context.x[block.begin], p.inverse_edge_x, p.cells_x) - k_x_fineness;
  const int high = cell_coordinate(context.x[block.end - 1], p.inverse_edge_x, p.cells_x) + k_x_fineness;
  const int first_x = low < 0 ? 0 : low;
  const int last_x = high < p.cells_x ? high : p.cells_x - 1;
  int count = 0;
  total = 0;
  for (int z = block.cell_z - 1; z <= block.cell_z + 1; ++z) {
    for (int y = block.cell_y - 1; y <= block.cell_y + 1; ++y) {
      if (z < 0 || z >= p.cells_z || y < 0 || y >= p.cells_y) continue;
      const int row = (z * p.cells_y + y) * p.cells_x;
      const Range range{context.cell_start[row + first_x], context.cell_start[row + last_x + 1]};
      if (range.begin == range.end) continue;
      ranges[count++] = range;
      total += range.end - range.begin;
    }
  }
  return count;
}

/// Walls near a block: exactly what evaluating every wall gives, without evaluating those out of reach.
template <class Pack>
struct Opening {
  Pack open{1.0f}, gradient_x{0.0f}, gradient_y{0.0f}, gradient_z{0.0f};
};

/// Whether a lane is within the support of a face of the container.
template <class Pack>
bool is_near_container(const PassContext<Scalar>& context, Mask valid, Pack x, Pack y, Pack z) {
  const Params<Scalar>& p = *context.params;
  const Pack reach(p.support_radius);
  const auto outside = [&](Pack coordinate, Scalar size) {
    return (coordinate < reach) | (Pack(size) - reach < coordinate);
  };
  return any(valid & (outside(x, p.size_x) | outside(y, p.size_y) | outside(z, p.size_z)));
}

/// Whether a lane is within the support of the box between two corners.
template <class Pack>
bool is_near_box(const PassContext<Scalar>& context, Mask valid, const Scalar* low, const Scalar* high, Pack x, Pack y,
                 Pack z) {
  const Pack reach(context.params->support_radius);
  const auto within = [&](Pack coordinate, int axis) {
    return (Pack(low[axis]) - reach < coordinate) & (coordinate < Pack(high[axis]) + reach);
  };
  return any(valid & within(x, 0) & within(y, 1) & within(z, 2));
}

template <class Pack>
Opening<Pack> opening(const PassContext<Scalar>& context, int kernel_shape, bool for_density, Mask valid, Pack x,
                      Pack y, Pack z) {
  const Params<Scalar>& p = *context.params;
  Opening<Pack> result;
  if (is_near_container(context, valid, x, y, z)) {
    const Pack shift(for_density ? p.density_wall_shift : p.force_wall_shift);
    result.open =
        container_opening(&p, kernel_shape, shift, x, y, z, &result.gradient_x, &result.gradient_y, &result.gradient_z);
  }
  for (int b = 0; b < context.substep->box_count; ++b) {
    const Box<Scalar>& box = context.boxes[b];
    const Scalar* low = for_density ? box.density_min : box.force_min;
    const Scalar* high = for_density ? box.density_max : box.force_max;
    if (!is_near_box(context, valid, low, high, x, y, z)) continue;
    result.open = close_box(&p, kernel_shape, low, high, x, y, z, result.open, &result.gradient_x, &result.gradient_y,
                            &result.gradient_z);
  }
  return result;
}

}  // namespace

}  // namespace squall::openmp
