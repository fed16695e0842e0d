#include "backend_omp/passes.h"

#include "backend_omp/omp_backend.h"

namespace squall::openmp {

std::vector<Simd> available_simd() {
  std::vector<Simd> available{Simd::scalar};
#ifdef SQUALL_HAS_X86_SIMD
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("aes") && __builtin_cpu_supports("pclmul");
  if (avx2) available.push_back(Simd::avx2);
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx2 && avx512) available.push_back(Simd::avx512);
#endif
  return available;
}

template <class Scalar>
const Passes<Scalar>& passes_for(Simd simd) {
#ifdef SQUALL_HAS_X86_SIMD
  if (simd == Simd::avx512) return avx512_passes<Scalar>();
  if (simd == Simd::avx2) return avx2_passes<Scalar>();
#endif
  (void)simd;
  return scalar_passes<Scalar>();
}

template const Passes<float>& passes_for(Simd simd);
template const Passes<double>& passes_for(Simd simd);

}  // namespace squall::openmp
