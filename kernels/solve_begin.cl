/* Reads:  sums of over-density. Writes: the state in which a sub-step's solves begin, and how much of the over-density
   they may correct (core/convergence.h).
   One work-item. */
#include "params.h"
#include "solve_state.h"
#include "switches.h"

#if SQUALL_DFSPH

__kernel void solve_begin(__global SolveState* state, __global const long* shares, int count,
                          __global const int* cell_start, __constant Params* p, __global const Substep* substeps,
                          int step) {
  long excess = sum_of_shares(shares, count);
  long allowed = convergence_term(substeps[step].correction) * cell_start[p->cell_count];
  state->correction = excess <= allowed ? 1.0f : convert_scalar_rte(allowed) / convert_scalar_rte(excess);
  state->iterations[0] = state->iterations[1] = 0;
  state->unconverged = 0;
  state->reserved = 0;
  begin_solve(state, SQUALL_DIVERGENCE_SOLVE);
}

#endif
