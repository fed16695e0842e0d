/* dfsph, a light pass: the second half of an iteration, unless its solve is over. Reads: positions, cell starts, by how
   much impulses change. Writes: impulses, and velocities into the records.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES == 1

#include "solve_pairs.h"

static inline Scalar4 pushed_sum(__constant Params* p, __global const Scalar4* records, __global const int* cell_start,
                                 Scalar4 place) {
  Scalar4 sum = (Scalar4)(0.0f);
  Neighbourhood cells = neighbourhood(p, place.x, place.y, place.z);
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) {
        Scalar4 other = records[2 * (size_t)j];
        Scalar4 way = place - other; /* w means nothing, here and in the sum */
        Scalar r2 = squared_length(way.x, way.y, way.z);
        if (!(r2 < p->list_squared)) continue; /* it would add exactly zero */
        sum = fma((Scalar4)(other.w * weight_of(p, r2)), way, sum);
      }
    }
  }
  return sum;
}

__kernel void push(__global Scalar4* records, __global const int* cell_start, __global Scalar* solve,
                   __global const SolveState* state, __constant Params* p, int stride, int this_solve) {
  int i = (int)get_global_id(0);
  if (state->solve != this_solve || i >= cell_start[p->cell_count]) return;
  Scalar4 place = records[2 * (size_t)i];
  Scalar change = place.w;
  Scalar4 sum = pushed_sum(p, records, cell_start, place);
  Scalar4 v = records[2 * (size_t)i + 1];
  Scalar warm = v.w;
  v += fma((Scalar4)(p->force_scale), sum, change * descent_of(solve, stride, i));
  v.w = warm;
  records[2 * (size_t)i + 1] = v;
  size_t impulse = field_of(SQUALL_IMPULSE, stride, i);
  solve[impulse] = max0(solve[impulse] + change);
}

#endif
