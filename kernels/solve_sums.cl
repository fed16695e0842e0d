/* Reads:  errors of all particles. Writes: this work-item's share of their sum, in integers: exact in any order.
   One work-item = every so many-th particle. */
#include "params.h"
#include "solve_state.h"
#include "switches.h"

#if SQUALL_DFSPH && SQUALL_LANES == 1

__kernel void solve_sums(__global const Scalar* errors, __global const int* cell_start,
                         __global const SolveState* state, __global long* shares, __constant Params* p, int solve) {
  if (solve >= 0 && state->solve != solve) return;
  int share = (int)get_global_id(0), step = (int)get_global_size(0);
  int active = cell_start[p->cell_count];
  long sum = 0;
  for (int i = share; i < active; i += step) sum += convergence_term(errors[i]);
  shares[share] = sum;
}

#endif
