/* Reads:  sums of errors. Writes: whether the solve goes on and how far its next iteration extrapolates, as
   core/convergence.h has it. `unit` is the tolerance as a sum's share, `least` and `most` are iterations.
   One work-item. */
#include "params.h"
#include "solve_state.h"
#include "switches.h"

#if SQUALL_DFSPH

__kernel void solve_decide(__global SolveState* state, __global const long* shares, int count,
                           __global const int* cell_start, __constant Params* p, long unit, int least, int most,
                           int solve) {
  if (state->solve != solve) return;
  long sum = sum_of_shares(shares, count);
  int converged = sum <= unit * cell_start[p->cell_count];
  int iteration = ++state->iterations[solve];
  state->before = state->last;
  state->last = sum;
  if ((converged && iteration >= least) || iteration >= most) {
    state->unconverged += !converged;
    begin_solve(state, solve + 1);
    return;
  }
  if (state->last > state->before) state->age = 0;
  state->momentum = (Scalar)state->age / (Scalar)(state->age + 3);
  ++state->age;
}

#endif
