/* dfsph. Reads and writes what prepare.cl does, over-density as this work-item's share of the sum; writes also the
   blocks' lists of neighbours and their weights. One work-item = one share of the rows, in blocks of SQUALL_LANES
   particles. For CPU devices. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES > 1

#include "solve_blocks.h"
#include "wall_openings.h"

typedef struct {
  Real even, odd;  /* kernel sums by the parity of the sorted index */
  Real squares;    /* of slopes */
  Vector apart;    /* of weight x_ij */
  Mask neighbours; /* minus their number, self included */
} PreparedSums;

/* Adds the candidates; keeps in the list those that any lane has within reach, and their weights, of which there is
   room for one more than `longest`. */
static inline int sum_batch(__constant Params* p, const Places* places, Real x, Real y, Real z, int count, int longest,
                            int* list, __global Real* weights, PreparedSums* sums) {
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    int j = list[k];
    Real dx = x - (Real)(places->x[j]), dy = y - (Real)(places->y[j]), dz = z - (Real)(places->z[j]);
    Real r2 = squared_length(dx, dy, dz);
    Real left = bell_left(r2, (Real)(p->inverse_support_squared));
    Real value = bell_value(left), weight = bell_weight(left);
    list[kept] = j;
#if SQUALL_WEIGHTS
    weights[min(kept, longest)] = weight;
#endif
    kept += any_lane(r2 < (Real)(p->list_squared));
    add_by_parity(value, j, &sums->even, &sums->odd);
    sums->neighbours += left > (Real)(0);
    sums->squares = plus_squared_slope(sums->squares, weight, r2);
    add_scaled(&sums->apart, weight, dx, dy, dz);
  }
  return kept;
}

static inline void sum_candidates(__constant Params* p, const Places* places, __global const int* cell_start,
                                  const Block* block, Real x, Real y, Real z, NeighbourLists* lists,
                                  __global Real* weight_memory, PreparedSums* sums) {
  sums->even = sums->odd = sums->squares = (Real)(0);
  sums->apart.x = sums->apart.y = sums->apart.z = (Real)(0);
  sums->neighbours = (Mask)(0);
  Search search;
  begin_search(p, cell_start, block, x, y, z, &search);
  int found[SQUALL_BATCH + 1];
  int longest = longest_list(lists, block);
  __global Real* weights = weight_memory + (lists->next - lists->memory);
  int batches = 0, kept;
  do {
    int count = search_batch(p, places, &search, found);
    kept = sum_batch(p, places, x, y, z, count, longest, found, weights, sums);
    ++batches;
  } while (!search_ended(&search));
  add_list(lists, block, found, batches == 1 ? kept : SQUALL_NO_LIST);
}

/* The open share at the block, and its gradient. */
static inline Real opening_of(__constant Params* p, __constant Box* boxes, int box_count, Real x, Real y, Real z,
                              Vector* e) {
  e->x = e->y = e->z = (Real)(0);
#if SQUALL_BOXES
  int walls_near = box_count > 0 || near_container(p, x, y, z);
#else
  int walls_near = near_container(p, x, y, z);
#endif
  return walls_near ? opening_with_cores(p, boxes, box_count, x, y, z, &e->x, &e->y, &e->z) : (Real)(1);
}

/* Where the block's solves begin: the divergence solve from no impulse, the density solve from that of the last
   pressure. */
static inline void begin_block(__constant Params* p, __global const Substep* now, const Block* block, Real density,
                               int stride, __global Scalar* records, __global Scalar* solve) {
  store_field(divergence_room(density, (Real)(p->free_density)), SQUALL_ROOM, stride, block, solve);
  store_field((Real)(0), SQUALL_IMPULSE, stride, block, solve);
  store_field((Real)(0), SQUALL_PROJECTED, stride, block, solve);
  for (int axis = 0; axis < 3; ++axis)
    store_field(gather(records, block, 4 + axis), SQUALL_START_VX + axis, stride, block, solve);
  Real largest = (Real)(p->largest_warm_impulse / now->dt);
  scatter(warm_impulse(gather(records, block, 3), (Real)(now->warm_kick), largest), block, 7, records);
}

/* Returns what the block adds to the sum of over-density. */
static inline long prepare_block(__global Scalar* records, __global Scalar* densities, __global Scalar* isolations,
                                 __global int* neighbours, const Places* places, __global const int* cell_start,
                                 __global Scalar* solve, __constant Params* p, __constant Box* boxes,
                                 __global const Substep* now, int stride, const Block* block, NeighbourLists* lists,
                                 __global Real* weights) {
  Real x = load_own(places->x, block), y = load_own(places->y, block), z = load_own(places->z, block);
  PreparedSums sums;
  sum_candidates(p, places, cell_start, block, x, y, z, lists, weights, &sums);
  Real kernel_sum = sums.even + sums.odd;
  Vector e;
  Real share = (Real)(1) - opening_of(p, boxes, now->box_count, x, y, z, &e);
  Real density = relative_density(kernel_sum, (Real)(p->density_scale), share);
  Real scale = (Real)(p->force_scale);
  Real hx = fma(scale, sums.apart.x, e.x), hy = fma(scale, sums.apart.y, e.y), hz = fma(scale, sums.apart.z, e.z);
  Real response = pressure_response(hx, hy, hz, sums.squares, scale);
  store_values(density, block, densities);
  store_field(hx, SQUALL_DESCENT_X, stride, block, solve);
  store_field(hy, SQUALL_DESCENT_Y, stride, block, solve);
  store_field(hz, SQUALL_DESCENT_Z, stride, block, solve);
  store_field(response, SQUALL_RESPONSE, stride, block, solve);
  store_field(inverse_response(response, (Real)(p->response_guard)), SQUALL_INVERSE_RESPONSE, stride, block, solve);
#if SQUALL_DRAG
  store_values(isolation(kernel_sum, (Real)(p->self_value), (Real)(p->density_scale), share, (Real)(p->steepness)),
               block, isolations);
#endif
  if (now->statistics) {
    MaskLane counts[SQUALL_LANES];
    store_lanes(sums.neighbours, counts);
    for (int i = block->begin; i < block->end; ++i) neighbours[i] = -counts[i - block->begin] - 1;
  }
  begin_block(p, now, block, density, stride, records, solve);
  return sum_of_terms(density - (Real)(1), block);
}

__kernel void prepare_blocks(__global Scalar* records, __global Scalar* densities, __global Scalar* isolations,
                             __global int* neighbours, __global const Scalar* x, __global const Scalar* y,
                             __global const Scalar* z, __global const int* cell_start, __global int* list_memory,
                             __global Real* weights, __global Scalar* solve, __global long* shares,
                             __constant Params* p, __constant Box* boxes, __global const Substep* substeps, int stride,
                             int step) {
  Places places = {x, y, z};
  Share share;
  take_share(p, cell_start, &share);
  NeighbourLists lists;
  open_lists(list_memory, &share, &lists);
  long excess = 0;
  for (int row = share.row; row < share.end_row; ++row) {
    int row_end = cell_start[(row + 1) * p->cells_x];
    for (int begin = cell_start[row * p->cells_x]; begin < row_end; begin += SQUALL_LANES) {
      Block block;
      make_block(p, x, row, begin, row_end, &block);
      excess += prepare_block(records, densities, isolations, neighbours, &places, cell_start, solve, p, boxes,
                              substeps + step, stride, &block, &lists, weights);
    }
  }
  shares[get_global_id(0)] = excess;
}

#endif
