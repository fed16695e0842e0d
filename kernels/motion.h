/* OpenCL only: |v|^2 and |a|^2 of a particle in the sub-step that wrote its record, 0 for one that was not moved. Most
   solvers leave both in the record's spare fields. dfsph keeps the pressure in the first, and -1 in the second where
   the particle was not moved. */
#ifndef SQUALL_MOTION_H
#define SQUALL_MOTION_H

#include "shared.h"
#include "switches.h"

static inline Scalar2 motion_of(Scalar4 position, Scalar4 velocity) {
#if SQUALL_DFSPH
  if (velocity.w < 0.0f) return (Scalar2)(0.0f, 0.0f);
  /* squared_length, which may be one of vectors here */
  return (Scalar2)(fma(velocity.z, velocity.z, fma(velocity.y, velocity.y, velocity.x * velocity.x)), velocity.w);
#else
  return (Scalar2)(position.w, velocity.w);
#endif
}

#endif
