#include "backend_omp/scalar_single.h"
//
#include "backend_omp/passes-inl.h"

namespace squall::openmp {

template <>
const Passes<float>& scalar_passes() {
  return BlockPasses<Pack>::table();
}

}  // namespace squall::openmp
