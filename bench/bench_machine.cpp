// What the processor can do at best: the bounds that the other programs' rows are held against.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "backend_omp/omp_backend.h"
#include "bench_support/bounds.h"
#include "bench_support/program.h"

namespace {

using namespace squall;
using namespace squall::bench;

double seconds_of(Effort effort) { return effort == Effort::smoke ? 1e-4 : effort == Effort::quick ? 2e-3 : 1e-2; }

std::vector<int> thread_counts() {
  const int all = static_cast<int>(std::thread::hardware_concurrency());
  return all > 1 ? std::vector<int>{1, all} : std::vector<int>{1};
}

void add_rates(const std::string& machine, const std::shared_ptr<HostProbe>& probe) {
  for (const Operation operation : k_operations) {
    const auto run = [probe, operation](::benchmark::State& state) {
      const double rate = probe->rate(operation);
      const double flops = operation == Operation::fma ? 2.0 : 1.0;
      for (auto _ : state) state.SetIterationTime(1e9 / rate);
      state.counters["operations_per_s"] = rate;
      state.counters["flops_per_s"] = flops * rate;
    };
    ::benchmark::RegisterBenchmark(("rate/" + std::string(to_string(operation)) + "/" + machine).c_str(), run)
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(::benchmark::kMillisecond);
  }
}

/// bytes: of all arrays of all threads together.
void add_stream(const std::string& machine, const std::shared_ptr<HostProbe>& probe, const std::string& where,
                std::size_t bytes) {
  for (const Stream stream : k_streams) {
    const auto run = [probe, stream, bytes](::benchmark::State& state) {
      const double bandwidth = probe->bandwidth(stream, bytes);
      for (auto _ : state) state.SetIterationTime(1e9 / bandwidth);
      state.counters["bytes_per_s"] = bandwidth;
    };
    std::string name = "stream/";
    name.append(to_string(stream)).append("/").append(where).append("/").append(machine);
    ::benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime()->Iterations(1)->Unit(::benchmark::kMillisecond);
  }
}

void add_rows(Effort effort) {
  constexpr std::size_t k_kib = 1024, k_mib = 1024 * k_kib;
  for (const int threads : thread_counts())
    for (const Simd simd : openmp::available_simd()) {
      const auto probe = std::make_shared<HostProbe>(simd, threads, seconds_of(effort));
      const std::string machine = std::string(squall::to_string(simd)) + "/threads:" + std::to_string(threads);
      const auto each = static_cast<std::size_t>(threads);
      add_rates(machine, probe);
      add_stream(machine, probe, "16KiB_each", 16 * k_kib * each);
      add_stream(machine, probe, "256KiB_each", 256 * k_kib * each);
      add_stream(machine, probe, "8MiB", 8 * k_mib);
      if (effort != Effort::smoke) add_stream(machine, probe, "256MiB", 256 * k_mib);
    }
}

}  // namespace

int main(int argc, char** argv) {
  return squall::bench::run_program(argc, argv, add_rows, [] { return false; });
}
