/* Reads:  sorted positions, cell starts. Writes: density, isolation, number of neighbours (in the sub-step that the
   frame report describes), the blocks' lists of neighbours, and into the record's spare fields what neighbours need of
   its pressure and volume. One work-item = one share of the rows, in blocks of SQUALL_LANES particles. For CPU devices.
 */
#include "shared.h"
#include "switches.h"

#if !SQUALL_DFSPH && SQUALL_LANES > 1

#include "lists.h"
#include "search.h"

typedef struct {
  Real even, odd;  /* kernel sums by the parity of the sorted index */
  Mask neighbours; /* minus their number, self included */
} KernelSum;

/* Positive for a neighbour that is (x, y, z) away. */
static inline Real reach_of(__constant Params* p, Real x, Real y, Real z) {
#if SQUALL_WCSPH
  return remaining_support(sqrt(squared_length(x, y, z)), (Real)(p->inverse_support));
#else
  return squared_support_left(x, y, z, (Real)(p->support_squared));
#endif
}

static inline Real kernel_value(__constant Params* p, Real r2, Real x, Real y, Real z) {
#if SQUALL_WCSPH
  Real r = sqrt(r2);
  return cubic_value(remaining_support(r, (Real)(p->inverse_support)),
                     remaining_support(r, (Real)(p->inverse_half_support)));
#else
  return poly6_value(squared_support_left(x, y, z, (Real)(p->support_squared)));
#endif
}

/* Adds the candidates; keeps in the list, and counts, those that any lane has within reach. */
static inline int sum_batch(__constant Params* p, const Places* places, Real x, Real y, Real z, int count, int* list,
                            KernelSum* sum) {
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    int j = list[k];
    Real dx = x - (Real)(places->x[j]), dy = y - (Real)(places->y[j]), dz = z - (Real)(places->z[j]);
    Real r2 = squared_length(dx, dy, dz);
    list[kept] = j;
    kept += any_lane(r2 < (Real)(p->list_squared));
    Real value = kernel_value(p, r2, dx, dy, dz);
    add_by_parity(value, j, &sum->even, &sum->odd);
  }
  return kept;
}

static inline void count_batch(__constant Params* p, const Places* places, Real x, Real y, Real z, int count,
                               const int* list, KernelSum* sum) {
  for (int k = 0; k < count; ++k) {
    int j = list[k];
    sum->neighbours +=
        reach_of(p, x - (Real)(places->x[j]), y - (Real)(places->y[j]), z - (Real)(places->z[j])) > (Real)(0);
  }
}

static inline void sum_kernel(__constant Params* p, const Places* places, __global const int* cell_start,
                              const Block* block, Real x, Real y, Real z, int statistics, NeighbourLists* lists,
                              KernelSum* sum) {
  sum->even = sum->odd = (Real)(0);
  sum->neighbours = (Mask)(0);
  Search search;
  begin_search(p, cell_start, block, x, y, z, &search);
  int found[SQUALL_BATCH + 1];
  int batches = 0, kept;
  do {
    int count = search_batch(p, places, &search, found);
    kept = sum_batch(p, places, x, y, z, count, found, sum);
    if (statistics) count_batch(p, places, x, y, z, kept, found, sum);
    ++batches;
  } while (!search_ended(&search));
  add_list(lists, block, found, batches == 1 ? kept : SQUALL_NO_LIST);
}

static inline void density_of_block(__global Scalar* records, __global Scalar* densities, __global Scalar* isolations,
                                    __global int* neighbours, const Places* places, __global const int* cell_start,
                                    __constant Params* p, __constant Box* boxes, __global const Substep* now,
                                    const Block* block, NeighbourLists* lists) {
  Real x = load_own(places->x, block), y = load_own(places->y, block), z = load_own(places->z, block);
  KernelSum sum;
  sum_kernel(p, places, cell_start, block, x, y, z, now->statistics, lists, &sum);
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
  Scalar density_lanes[SQUALL_LANES], volume_lanes[SQUALL_LANES], pressure_lanes[SQUALL_LANES];
  MaskLane neighbour_lanes[SQUALL_LANES];
  store_lanes(density, density_lanes);
  store_lanes(volume_term, volume_lanes);
  store_lanes(pressure_term, pressure_lanes);
  store_lanes(sum.neighbours, neighbour_lanes);
#if SQUALL_DRAG
  Scalar isolation_lanes[SQUALL_LANES];
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

__kernel void density_blocks(__global Scalar* records, __global Scalar* densities, __global Scalar* isolations,
                             __global int* neighbours, __global const Scalar* x, __global const Scalar* y,
                             __global const Scalar* z, __global const int* cell_start, __global int* list_memory,
                             __constant Params* p, __constant Box* boxes, __global const Substep* substeps, int step) {
  Places places = {x, y, z};
  Share share;
  take_share(p, cell_start, &share);
  NeighbourLists lists;
  open_lists(list_memory, &share, &lists);
  for (int row = share.row; row < share.end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      make_block(p, x, row, begin, row_end, &block);
      density_of_block(records, densities, isolations, neighbours, &places, cell_start, p, boxes, substeps + step,
                       &block, &lists);
    }
  }
}

#endif
