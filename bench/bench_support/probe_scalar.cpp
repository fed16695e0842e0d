#include "backend_omp/scalar_single.h"
//
#include "bench_support/probe-inl.h"

namespace squall::bench {

const Probe& scalar_probe() { return ProbeOf<openmp::Pack>::table(); }

}  // namespace squall::bench
