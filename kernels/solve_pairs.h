/* OpenCL only: what dfsph's kernels with a work-item per particle share. A record is {x, y, z, change of the impulse}
   {vx, vy, vz, impulse to start from}; each pass writes only halves, or fields, that no other particle reads in it. */
#ifndef SQUALL_SOLVE_PAIRS_H
#define SQUALL_SOLVE_PAIRS_H

#include "dfsph_formulas.h"
#include "neighbour_rows.h"
#include "solve_state.h"
#include "switches.h"

/* A value that the solves keep of particle i. */
static inline size_t field_of(int field, int stride, int i) { return (size_t)field * (size_t)stride + (size_t)i; }

static inline Scalar4 descent_of(__global const Scalar* solve, int stride, int i) {
  return (Scalar4)(solve[field_of(SQUALL_DESCENT_X, stride, i)], solve[field_of(SQUALL_DESCENT_Y, stride, i)],
                   solve[field_of(SQUALL_DESCENT_Z, stride, i)], 0.0f);
}

/* Of a pair within reach, r^2 = r2. */
static inline Scalar weight_of(__constant Params* p, Scalar r2) {
  return bell_weight(bell_left(r2, p->inverse_support_squared));
}

#endif
