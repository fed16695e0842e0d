/* Reads:  sorted records with pressure and volume terms, densities, isolations, cell starts. Writes: the records after
   the sub-step, in the same order, with |v|^2 and |a|^2 in their spare fields; counts clamps. Held and lost particles
   are copied.
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if !SQUALL_DFSPH && SQUALL_LANES == 1

#include "integrate.h"
#include "pair_sums.h"

__kernel void forces(__global const Scalar4* sorted, __global Scalar4* records, __global const Scalar* densities,
                     __global const Scalar* isolations, __global const int* cell_start, __global int* clamps,
                     __constant Params* p, __constant Box* boxes, __global const Substep* substeps, int step,
                     int count) {
  int i = (int)get_global_id(0);
  if (i >= count) return;
  Scalar4 position = sorted[2 * (size_t)i];
  Scalar4 velocity = sorted[2 * (size_t)i + 1];
  Scalar speed2 = 0, acceleration2 = 0;
  if (i < cell_start[p->cell_count]) {
    __global const Substep* now = substeps + step;
    Scalar4 a = fluid_acceleration(sorted, cell_start, p, boxes, now->box_count, position, velocity, densities[i]);
    a += (Scalar4)(now->acceleration_x, now->acceleration_y, now->acceleration_z, 0.0f);
#if SQUALL_DRAG
    a = with_drag(p, now, a, velocity, isolations[i]);
#endif
    int event = integrate(p, boxes, now, a, &position, &velocity);
    if (event & SQUALL_CLAMPED) atomic_inc(clamps);
    if (!(event & SQUALL_LOST)) {
      speed2 = squared_length(velocity.x, velocity.y, velocity.z);
      acceleration2 = squared_length(a.x, a.y, a.z);
    }
  }
  position.w = speed2;
  velocity.w = acceleration2;
  records[2 * (size_t)i] = position;
  records[2 * (size_t)i + 1] = velocity;
}

#endif
