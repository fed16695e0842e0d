/* dfsph, after its solves. Reads and writes the records: moves them where their velocities lead; counts clamps. What
   stays in the spare fields is the pressure, and |a|^2 or -1 (motion.h).
   One work-item = one particle. */
#include "shared.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES == 1

#include "integrate.h"
#include "solve_pairs.h"

__kernel void drift(__global Scalar4* records, __global const int* cell_start, __global const Scalar* solve,
                    __global int* clamps, __global const SolveState* state, __constant Params* p, __constant Box* boxes,
                    __global const Substep* substeps, int stride, int step, int count) {
  int i = (int)get_global_id(0);
  if (state->solve != SQUALL_SOLVED || i >= count) return;
  if (i >= cell_start[p->cell_count]) {
    ((__global Scalar*)records)[8 * (size_t)i + 7] = -1.0f;
    return;
  }
  __global const Substep* now = substeps + step;
  Scalar4 position = records[2 * (size_t)i], velocity = records[2 * (size_t)i + 1];
  /* Not as vectors whose w is never used: Oclgrind's check of uninitialised values crashes on these. */
  Scalar ax = (velocity.x - solve[field_of(SQUALL_START_VX, stride, i)]) * now->inverse_kick;
  Scalar ay = (velocity.y - solve[field_of(SQUALL_START_VY, stride, i)]) * now->inverse_kick;
  Scalar az = (velocity.z - solve[field_of(SQUALL_START_VZ, stride, i)]) * now->inverse_kick;
  int event = move(p, boxes, now, &position, &velocity);
  if (event & SQUALL_CLAMPED) atomic_inc(clamps);
  position.w = solve[field_of(SQUALL_IMPULSE, stride, i)] * now->inverse_kick;
  velocity.w = event & SQUALL_LOST ? -1.0f : squared_length(ax, ay, az);
  records[2 * (size_t)i] = position;
  records[2 * (size_t)i + 1] = velocity;
}

#endif
