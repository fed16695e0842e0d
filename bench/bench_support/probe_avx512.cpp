#include "backend_omp/highway_single.h"
//
#include "bench_support/probe-inl.h"

namespace squall::bench {

const Probe& avx512_probe() { return ProbeOf<openmp::Pack>::table(); }

}  // namespace squall::bench
