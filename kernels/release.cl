/* Reads:  ids, the sub-step's released groups. Writes: velocities of the particles freed now.
   Undoes half of the last kick for them: they start with half a kick, like everything at the start.
   One work-item = one particle. */
#include "params.h"

__kernel void release(__global Scalar4* records, __global const uint* ids, __constant Params* p,
                      __constant HeldGroup* groups, __global const Substep* substeps, int step, int count) {
  int i = (int)get_global_id(0);
  if (i >= count) return;
  __global const Substep* now = substeps + step;
  Scalar half_kick = now->previous_dt * p->one_half;
  Scalar4 velocity = records[2 * (size_t)i + 1];
  for (int g = now->held_count; g < now->held_count + now->released_count; ++g) {
    if (ids[i] < groups[g].first_id || ids[i] >= groups[g].end_id) continue;
    velocity.x = fma(-half_kick, now->acceleration_x, velocity.x);
    velocity.y = fma(-half_kick, now->acceleration_y, velocity.y);
    velocity.z = fma(-half_kick, now->acceleration_z, velocity.z);
    records[2 * (size_t)i + 1] = velocity;
  }
}
