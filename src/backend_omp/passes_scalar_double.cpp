#include "backend_omp/scalar_double.h"
//
#include "backend_omp/passes-inl.h"

namespace squall::openmp {

template <>
const Passes<double>& scalar_passes() {
  return BlockPasses<Pack>::table();
}

}  // namespace squall::openmp
