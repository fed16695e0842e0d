/* dfsph. Reads: positions in sorted order, cell starts, velocities and last pressures of the records. Writes: density,
   isolation, number of neighbours (in the sub-step that the frame report describes), what the solves need of a
   particle, over-density, and into the records' last field the impulse to start from.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES == 1

#include "solve_pairs.h"
#include "wall_openings.h"

typedef struct {
  Scalar even, odd; /* kernel sums by the parity of the sorted index */
  Scalar squares;   /* of slopes */
  Scalar4 apart;    /* of weight x_ij */
  int neighbours;   /* self included */
} PreparedSums;

static inline void add_candidate(__constant Params* p, Scalar4 from, Scalar4 to, int j, PreparedSums* sums) {
  Scalar4 way = from - to; /* w means nothing, here and in the sum */
  Scalar r2 = squared_length(way.x, way.y, way.z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  Scalar left = bell_left(r2, p->inverse_support_squared);
  Scalar weight = bell_weight(left), value = bell_value(left);
  if (j & 1)
    sums->odd += value;
  else
    sums->even += value;
  sums->neighbours += left > 0.0f;
  sums->apart = fma((Scalar4)(weight), way, sums->apart);
  sums->squares = plus_squared_slope(sums->squares, weight, r2);
}

static inline void sum_candidates(__constant Params* p, __global const Scalar4* places, __global const int* cell_start,
                                  Scalar4 at, PreparedSums* sums) {
  sums->even = sums->odd = sums->squares = 0.0f;
  sums->apart = (Scalar4)(0.0f);
  sums->neighbours = 0;
  Neighbourhood cells = neighbourhood(p, at.x, at.y, at.z);
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) add_candidate(p, at, places[j], j, sums);
    }
  }
}

__kernel void prepare(__global const Scalar4* places, __global Scalar* records, __global Scalar* densities,
                      __global Scalar* isolations, __global int* neighbours, __global const int* cell_start,
                      __global Scalar* solve, __global Scalar* errors, __constant Params* p, __constant Box* boxes,
                      __global const Substep* substeps, int stride, int step) {
  int i = (int)get_global_id(0);
  if (i >= cell_start[p->cell_count]) return;
  __global const Substep* now = substeps + step;
  Scalar4 at = places[i];
  PreparedSums sums;
  sum_candidates(p, places, cell_start, at, &sums);
  Scalar kernel_sum = sums.even + sums.odd;
  Scalar ex, ey, ez;
  Scalar share = 1 - opening_with_cores(p, boxes, now->box_count, at.x, at.y, at.z, &ex, &ey, &ez);
  Scalar density = relative_density(kernel_sum, p->density_scale, share);
  Scalar hx = fma(p->force_scale, sums.apart.x, ex), hy = fma(p->force_scale, sums.apart.y, ey),
         hz = fma(p->force_scale, sums.apart.z, ez);
  Scalar response = pressure_response(hx, hy, hz, sums.squares, p->force_scale);
  densities[i] = density;
  errors[i] = density - 1;
#if SQUALL_DRAG
  isolations[i] = isolation(kernel_sum, p->self_value, p->density_scale, share, p->steepness);
#endif
  if (now->statistics) neighbours[i] = sums.neighbours - 1;
  solve[field_of(SQUALL_DESCENT_X, stride, i)] = hx;
  solve[field_of(SQUALL_DESCENT_Y, stride, i)] = hy;
  solve[field_of(SQUALL_DESCENT_Z, stride, i)] = hz;
  solve[field_of(SQUALL_RESPONSE, stride, i)] = response;
  solve[field_of(SQUALL_INVERSE_RESPONSE, stride, i)] = inverse_response(response, p->response_guard);
  solve[field_of(SQUALL_ROOM, stride, i)] = divergence_room(density, p->free_density);
  solve[field_of(SQUALL_IMPULSE, stride, i)] = 0.0f;
  solve[field_of(SQUALL_PROJECTED, stride, i)] = 0.0f;
  __global Scalar* record = records + 8 * (size_t)i;
  for (int axis = 0; axis < 3; ++axis) solve[field_of(SQUALL_START_VX + axis, stride, i)] = record[4 + axis];
  record[7] = warm_impulse(record[3], now->warm_kick, p->largest_warm_impulse / now->dt);
}

#endif
