#include "backend_omp/highway_single.h"
//
#include "backend_omp/passes-inl.h"

#if HWY_STATIC_TARGET != HWY_AVX2
#error "compile this file for AVX2 and FMA"
#endif

namespace squall::openmp {

template <>
const Passes<float>& avx2_passes() {
  return BlockPasses<Pack>::table();
}

}  // namespace squall::openmp
