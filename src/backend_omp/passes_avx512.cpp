#include "backend_omp/highway_single.h"
//
#include "backend_omp/passes-inl.h"

#if HWY_STATIC_TARGET != HWY_AVX3
#error "compile this file for AVX-512 F, BW, CD, DQ and VL"
#endif

namespace squall::openmp {

template <>
const Passes<float>& avx512_passes() {
  return BlockPasses<Pack>::table();
}

}  // namespace squall::openmp
