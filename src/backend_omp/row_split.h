#pragma once

#include "backend_omp/passes.h"

namespace squall::openmp {

/// Share `part` of `parts` of the rows of cells, the same in every pass of a sub-step: contiguous, disjoint, all rows
/// together, with nearly equal numbers of blocks of `lanes` particles, which is what the passes' time goes by.
template <class Scalar>
Range split_rows(const int* cell_start, const Params<Scalar>& p, int lanes, int part, int parts);

}  // namespace squall::openmp
