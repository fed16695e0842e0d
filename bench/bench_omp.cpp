// The omp backend: whole steps and stages, by size, pressure solver, instruction set and threads.
#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "backend_omp/omp_backend.h"
#include "bench_support/bounds.h"
#include "bench_support/program.h"
#include "bench_support/solver_rows.h"

namespace {

using namespace squall;
using namespace squall::bench;

Variant variant_of(Simd simd, int threads) {
  Variant variant;
  variant.name = std::string("omp/") + squall::to_string(simd) + "/threads:" + std::to_string(threads);
  variant.backend = "omp";
  variant.settings.simd = simd;
  variant.settings.threads = threads;
  variant.walk = {probe_for(simd).lanes, Way::box_and_list};
  variant.threads = threads;
  return variant;
}

/// A million particles at one lane take a minute by themselves, and twenty thousand say the same.
bool is_too_slow(Size size, Simd simd) { return simd == Simd::scalar && size.particles() > 20'000; }

class Bench {
 public:
  explicit Bench(Effort effort)
      : cases_(effort),
        rows_(cases_, [this](const Variant& variant, std::size_t bytes) { return bounds(variant, bytes); }) {
    const int all = static_cast<int>(std::thread::hardware_concurrency());
    for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller})
      for (const Size size : sizes_for(effort))
        for (const Simd simd : openmp::available_simd())
          for (int threads = 1; threads <= all; threads += std::max(all - 1, 1)) {
            if (is_too_slow(size, simd)) continue;
            rows_.add_step(pressure, size, variant_of(simd, threads));
            rows_.add_stages(pressure, size, variant_of(simd, threads));
          }
  }
  bool failed() const { return rows_.failed(); }

 private:
  Bounds bounds(const Variant& variant, std::size_t bytes) {
    const double seconds = cases_.effort() == Effort::smoke ? 1e-4 : 1e-3;
    return probes_
        .try_emplace({variant.settings.simd, variant.threads}, variant.settings.simd, variant.threads, seconds)
        .first->second.measure(bytes);
  }

  Cases cases_;
  SolverRows rows_;
  std::map<std::pair<Simd, int>, HostProbe> probes_;
};

}  // namespace

int main(int argc, char** argv) {
  std::unique_ptr<Bench> bench;
  return squall::bench::run_program(
      argc, argv, [&](Effort effort) { bench = std::make_unique<Bench>(effort); }, [&] { return bench->failed(); });
}
