/* dfsph, between its solves. Reads: positions and records in sorted order, cell starts, densities, isolations. Writes:
   where the density solve starts: records with velocities after gravity, drag, viscosity, smoothing and the impulses to
   start from. Held and lost particles are copied.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES == 1

#include "integrate.h"
#include "solve_pairs.h"

typedef struct {
  Scalar4 pushed, smoothed;
} Prediction;

static inline void add_pair(__constant Params* p, Scalar viscous, Scalar4 place, Scalar4 motion, Scalar4 other_place,
                            Scalar4 other_motion, Prediction* sums) {
  Scalar4 way = place - other_place; /* w means nothing, here and in the sums */
  Scalar r2 = squared_length(way.x, way.y, way.z);
  if (!(r2 < p->list_squared)) return; /* it would add exactly zero */
  Scalar impulse = other_motion.w;
#if SQUALL_VISCOSITY
  Scalar4 speed = motion - other_motion;
  Scalar receding = dot_product(way.x, way.y, way.z, speed.x, speed.y, speed.z);
  impulse = viscous_pair_push(impulse, viscous, receding);
#endif
  sums->pushed = fma((Scalar4)(impulse * weight_of(p, r2)), way, sums->pushed);
#if SQUALL_SMOOTHING
  Scalar value = bell_value(bell_left(r2, p->inverse_support_squared));
  sums->smoothed = fma((Scalar4)(value), other_motion - motion, sums->smoothed);
#endif
}

static inline void predict_from_neighbours(__constant Params* p, __global const Scalar4* places,
                                           __global const Scalar4* records, __global const int* cell_start, Scalar kick,
                                           Scalar4 place, Scalar4 motion, Prediction* sums) {
  sums->pushed = sums->smoothed = (Scalar4)(0.0f);
  Scalar viscous = p->viscosity_scale * kick;
  Neighbourhood cells = neighbourhood(p, place.x, place.y, place.z);
  for (int z = cells.first_z; z <= cells.last_z; ++z) {
    for (int y = cells.first_y; y <= cells.last_y; ++y) {
      int2 range = candidates(p, cell_start, cells, y, z);
      for (int j = range.x; j < range.y; ++j)
        add_pair(p, viscous, place, motion, places[j], records[2 * (size_t)j + 1], sums);
    }
  }
}

__kernel void predict(__global const Scalar4* places, __global const Scalar4* sorted, __global Scalar4* records,
                      __global const Scalar* densities, __global const Scalar* isolations,
                      __global const int* cell_start, __global Scalar* solve, __global const SolveState* state,
                      __constant Params* p, __global const Substep* substeps, int stride, int step, int count) {
  int i = (int)get_global_id(0);
  if (state->solve != SQUALL_DENSITY_SOLVE || i >= count) return;
  Scalar4 place = sorted[2 * (size_t)i], motion = sorted[2 * (size_t)i + 1];
  if (i < cell_start[p->cell_count]) {
    __global const Substep* now = substeps + step;
    Scalar impulse = motion.w;
    Prediction sums;
    predict_from_neighbours(p, places, sorted, cell_start, now->kick, place, motion, &sums);
    Scalar4 a = (Scalar4)(0.0f) + (Scalar4)(now->acceleration_x, now->acceleration_y, now->acceleration_z, 0.0f);
#if SQUALL_DRAG
    a = with_drag(p, now, a, motion, isolations[i]);
#endif
    motion = fma((Scalar4)(now->kick), a, motion) +
             fma((Scalar4)(p->force_scale), sums.pushed, impulse * descent_of(solve, stride, i));
#if SQUALL_SMOOTHING
    motion = fma((Scalar4)(p->smoothing_scale * now->dt), sums.smoothed, motion);
#endif
    place.w = motion.w = 0.0f;
    solve[field_of(SQUALL_IMPULSE, stride, i)] = impulse;
    solve[field_of(SQUALL_PROJECTED, stride, i)] = impulse;
    solve[field_of(SQUALL_ROOM, stride, i)] = density_room(densities[i], state->correction);
  }
  records[2 * (size_t)i] = place;
  records[2 * (size_t)i + 1] = motion;
}

#endif
