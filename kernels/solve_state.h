/* How far the solves of dfsph are in a sub-step, kept on the device: kernels of an iteration look at it and do nothing
   once their solve is over, so that the host may enqueue more iterations than it takes (docs/dfsph.md). And where the
   values are that the solves keep of each particle. */
#ifndef SQUALL_SOLVE_STATE_H
#define SQUALL_SOLVE_STATE_H

#define SQUALL_DIVERGENCE_SOLVE 0
#define SQUALL_DENSITY_SOLVE 1
#define SQUALL_SOLVED 2

/* Fields of the solves' memory: one array after the other, a value per sorted particle. */
#define SQUALL_DESCENT_X 0 /* minus the gradient of a particle's own density, 1/m */
#define SQUALL_DESCENT_Y 1
#define SQUALL_DESCENT_Z 2
#define SQUALL_RESPONSE 3
#define SQUALL_INVERSE_RESPONSE 4
#define SQUALL_ROOM 5
#define SQUALL_IMPULSE 6
#define SQUALL_PROJECTED 7
#define SQUALL_START_VX 8 /* before the solves, m/s */
#define SQUALL_START_VY 9
#define SQUALL_START_VZ 10
#define SQUALL_SOLVE_FIELDS 11

#ifdef __cplusplus

#include <cstddef>
#include <cstdint>

namespace squall {

/// As the kernels write it, but for two numbers of theirs that follow.
struct SolveState {
  std::int64_t last, before;   ///< sums of errors that the last two iterations found
  std::int32_t solve;          ///< under way: SQUALL_DIVERGENCE_SOLVE, SQUALL_DENSITY_SOLVE, or SQUALL_SOLVED
  std::int32_t iterations[2];  ///< of each
  std::int32_t unconverged;    ///< solves that the limit of iterations cut short
  std::int32_t age;            ///< iterations since the start or since the error last grew
  std::int32_t reserved;
};
static_assert(sizeof(SolveState) == 40);
inline constexpr std::size_t k_solve_state_bytes = sizeof(SolveState) + 2 * sizeof(double);

}  // namespace squall

#else

#include "shared.h"

typedef struct {
  long last, before;
  int solve, iterations[2], unconverged, age, reserved;
  Scalar momentum;   /* of the next iteration */
  Scalar correction; /* share of over-density that goes away in this sub-step */
} SolveState;

/* core/convergence.h: what an error adds to the sum that decides. Not a number counts as 0. */
static inline long convergence_term(Scalar error) {
  Scalar clamped = error > 0.0f ? (error < 1024.0f ? error : 1024.0f) : 0.0f;
  return convert_long_rte(clamped * 4294967296.0f); /* 2^32 */
}

static inline long sum_of_shares(__global const long* shares, int count) {
  long sum = 0;
  for (int k = 0; k < count; ++k) sum += shares[k];
  return sum;
}

/* The first iteration of a solve does not extrapolate, and nothing is known of its error. */
static inline void begin_solve(__global SolveState* state, int solve) {
  state->solve = solve;
  state->last = state->before = 0x7fffffffffffffffL;
  state->momentum = 0.0f;
  state->age = 1;
}

#endif
#endif
