/* dfsph, a light pass: the first half of an iteration, unless its solve is over. Reads: positions in sorted order, cell
   starts, velocities. Writes: errors, and into the records by how much impulses change.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES == 1

#include "solve_pairs.h"

static inline Scalar approaching_sum(__constant Params* p, __global const Scalar4* places,
                                     __global const Scalar4* records, __global const int* cell_start, Scalar4 place) {
  Scalar sum = 0.0f;
  Neighbourhood cells = neighbourhood(p, place.x, place.y, place.z);
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j) {
        Scalar4 way = place - places[j];
        Scalar r2 = squared_length(way.x, way.y, way.z);
        if (!(r2 < p->list_squared)) continue; /* it would add exactly zero */
        Scalar4 speed = records[2 * (size_t)j + 1];
        sum = fma(weight_of(p, r2), dot_product(way.x, way.y, way.z, speed.x, speed.y, speed.z), sum);
      }
    }
  }
  return sum;
}

__kernel void rate(__global const Scalar4* places, __global Scalar4* records, __global const int* cell_start,
                   __global Scalar* solve, __global Scalar* errors, __global const SolveState* state,
                   __constant Params* p, __global const Substep* substeps, int stride, int step, int this_solve) {
  int i = (int)get_global_id(0);
  if (state->solve != this_solve || i >= cell_start[p->cell_count]) return;
  __global const Substep* now = substeps + step;
  Scalar4 motion = records[2 * (size_t)i + 1];
  Scalar sum = approaching_sum(p, places, records, cell_start, places[i]);
  Scalar4 h = descent_of(solve, stride, i);
  Scalar along = dot_product(motion.x, motion.y, motion.z, h.x, h.y, h.z);
  Scalar impulse = solve[field_of(SQUALL_IMPULSE, stride, i)];
  Scalar inverse = solve[field_of(SQUALL_INVERSE_RESPONSE, stride, i)];
  Scalar before = solve[field_of(SQUALL_PROJECTED, stride, i)];
  Scalar lack = lack_of_compression(solve[field_of(SQUALL_ROOM, stride, i)], now->dt,
                                    compression_rate(sum, p->force_scale, along));
  Scalar projected = projected_impulse(impulse, lack, now->relaxation_rate, inverse);
  solve[field_of(SQUALL_PROJECTED, stride, i)] = projected;
  ((__global Scalar*)records)[8 * (size_t)i + 3] = extrapolated_impulse(projected, before, state->momentum) - impulse;
  errors[i] = solve_error(lack, impulse, now->dt, solve[field_of(SQUALL_RESPONSE, stride, i)], inverse);
}

#endif
