#include "backend_omp/scalar_pack.h"
//
#include "backend_omp/passes-inl.h"

namespace squall::openmp {

const Passes& scalar_passes() { return BlockPasses<Pack>::table(); }

}  // namespace squall::openmp
