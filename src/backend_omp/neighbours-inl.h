#pragma once

// Included once per instruction set and precision, after its Pack: which particles a block may have as neighbours.

#include "backend_omp/block-inl.h"

namespace squall::openmp {

namespace {

/// The box around the particles of a block, every lane alike.
template <class Pack>
struct Bounds {
  Pack low[3], high[3];

  Bounds(const Block& block, const Pack* position) {
    const Mask valid = first_lanes(block.count());
    for (int axis = 0; axis < 3; ++axis) {
      const Pack inside = select(valid, position[axis], Pack(first_lane(position[axis])));
      low[axis] = smallest_lane(inside);
      high[axis] = largest_lane(inside);
    }
  }

  /// Square of the distance from points outside; 0 inside.
  Pack squared_distance(Pack x, Pack y, Pack z) const {
    return squared_length(outside(x, 0), outside(y, 1), outside(z, 2));
  }

 private:
  Pack outside(Pack coordinate, int axis) const {
    return coordinate - smaller(larger(coordinate, low[axis]), high[axis]);
  }
};

/// Appends to `list`, in canonical order, every candidate that lies within H (1 + 5e-6) of the box around the block: a
/// superset of what lies within H of any of its particles, found for a vector of candidates at a time. What is beyond H
/// adds exactly zero to every sum. Scribbles over up to k_lanes entries behind the last. Returns how many.
template <class Pack>
int find_neighbours(const PassContext<Scalar>& context, const Range* ranges, int range_count, const Bounds<Pack> bounds,
                    int* list) {
  const Pack reach2(context.params->list_squared);
  const Scalar *x = context.x, *y = context.y, *z = context.z;
  const int* const begin = list;
  for (int k = 0; k < range_count; ++k) {
    const int end = ranges[k].end;
    for (int j = ranges[k].begin; j < end; j += Pack::k_lanes) {
      const Pack distance2 = bounds.squared_distance(Pack::load(x + j), Pack::load(y + j), Pack::load(z + j));
      list += append_lanes(list, j, distance2 < reach2, end - j);
    }
  }
  return static_cast<int>(list - begin);
}

}  // namespace

}  // namespace squall::openmp
