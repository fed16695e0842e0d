/* Reads:  positions of the sorted records, cell starts. Writes: density, isolation, number of neighbours (in the
   sub-step that the frame report describes), and into the record's spare fields what neighbours need of its pressure
   and volume. One work-item = one share of the rows, in blocks of SQUALL_LANES particles. For CPU devices. */
#include "shared.h"

#if SQUALL_LANES > 1

#include "blocks.h"

typedef struct {
  Real even, odd;  /* kernel sums by the parity of the sorted index */
  Mask neighbours; /* minus their number, self included */
} KernelSum;

static inline Real kernel_value(__constant Params* p, __global const float* at, Real x, Real y, Real z, int statistics,
                                Mask* neighbours) {
  Real dx = x - (Real)(at[0]), dy = y - (Real)(at[1]), dz = z - (Real)(at[2]);
#if SQUALL_WCSPH
  Real r = sqrt(squared_length(dx, dy, dz));
  Real reach = remaining_support(r, (Real)(p->inverse_support));
  Real value = cubic_value(reach, remaining_support(r, (Real)(p->inverse_half_support)));
#else
  Real reach = squared_support_left(dx, dy, dz, (Real)(p->support_squared));
  Real value = poly6_value(reach);
#endif
  if (statistics) *neighbours += reach > (Real)(0);
  return value;
}

static inline void sum_kernel(__constant Params* p, __global const float* records, __global const int* cell_start,
                              const Block* block, Real x, Real y, Real z, int statistics, KernelSum* sum) {
  sum->even = sum->odd = (Real)(0);
  sum->neighbours = (Mask)(0);
  Walk walk;
  begin_walk(block, &walk);
  int even[SQUALL_BATCH + 1], odd[SQUALL_BATCH + 1];
  while (has_candidates(p, cell_start, block, &walk)) {
    int evens = 0, odds = 0;
    int end = min(walk.next + SQUALL_BATCH, walk.end);
    for (int j = walk.next; j < end; ++j) {
      int hit = in_reach(p, records, j, x, y, z);
      even[evens] = j;
      odd[odds] = j;
      evens += hit & ~j;
      odds += hit & j;
    }
    walk.next = end;
    for (int k = 0; k < evens; ++k)
      sum->even += kernel_value(p, records + 8 * (size_t)even[k], x, y, z, statistics, &sum->neighbours);
    for (int k = 0; k < odds; ++k)
      sum->odd += kernel_value(p, records + 8 * (size_t)odd[k], x, y, z, statistics, &sum->neighbours);
  }
}

static inline void density_of_block(__global float* records, __global float* densities, __global float* isolations,
                                    __global int* neighbours, __global const int* cell_start, __constant Params* p,
                                    __constant Box* boxes, __global const Substep* now, const Block* block) {
  Real x = gather(records, block, 0), y = gather(records, block, 1), z = gather(records, block, 2);
  KernelSum sum;
  sum_kernel(p, records, cell_start, block, x, y, z, now->statistics, &sum);
  Real kernel_sum = sum.even + sum.odd;
  Real share = (Real)(0);
#if SQUALL_BOXES
  int walls_near = now->box_count > 0 || near_container(p, x, y, z);
#else
  int walls_near = near_container(p, x, y, z);
#endif
  if (walls_near) share = (Real)(1) - density_opening(p, boxes, now->box_count, x, y, z);
  Real density = relative_density(kernel_sum, (Real)(p->density_scale), share);
#if SQUALL_WCSPH
  Real volume_term = (Real)(1) / density;
  Real pressure_term = tait_pressure(density, (Real)(p->stiffness)) / (density * density);
#else
  Real volume_term = (Real)(p->one_half) / density;
  Real pressure_term = mueller_pressure(density, (Real)(p->stiffness), (Real)(p->tension)) * volume_term;
#endif
  float density_lanes[SQUALL_LANES], volume_lanes[SQUALL_LANES], pressure_lanes[SQUALL_LANES];
  int neighbour_lanes[SQUALL_LANES];
  store_lanes(density, density_lanes);
  store_lanes(volume_term, volume_lanes);
  store_lanes(pressure_term, pressure_lanes);
  store_lanes(sum.neighbours, neighbour_lanes);
#if SQUALL_DRAG
  float isolation_lanes[SQUALL_LANES];
  store_lanes(isolation(kernel_sum, (Real)(p->self_value), (Real)(p->density_scale), share, (Real)(p->steepness)),
              isolation_lanes);
#endif
  for (int i = block->begin; i < block->end; ++i) {
    int lane = i - block->begin;
    records[8 * (size_t)i + 3] = pressure_lanes[lane];
    records[8 * (size_t)i + 7] = volume_lanes[lane];
    densities[i] = density_lanes[lane];
    if (now->statistics) neighbours[i] = -neighbour_lanes[lane] - 1;
#if SQUALL_DRAG
    isolations[i] = isolation_lanes[lane];
#endif
  }
}

__kernel void density_blocks(__global float* records, __global float* densities, __global float* isolations,
                             __global int* neighbours, __global const int* cell_start, __constant Params* p,
                             __constant Box* boxes, __global const Substep* substeps, int step) {
  int part = (int)get_global_id(0), parts = (int)get_global_size(0);
  int end_row = row_split(p, cell_start, part + 1, parts);
  for (int row = row_split(p, cell_start, part, parts); row < end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      make_block(p, records, row, begin, row_end, &block);
      density_of_block(records, densities, isolations, neighbours, cell_start, p, boxes, substeps + step, &block);
    }
  }
}

#endif
