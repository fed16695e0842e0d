#include "bench_support/bounds.h"

#include <omp.h>

#include <algorithm>
#include <chrono>

#include "backend_omp/team_barrier.h"

namespace squall::bench {

namespace {

constexpr int k_runs = 5;
constexpr std::size_t k_step = 64;  ///< elements: all arrays begin at cache lines and hold whole vectors

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The shortest of a few runs, repeated with twice the work until even that takes `least` seconds: one run that
/// something else holds up must not pass for a long one.
template <class Run>
double best_of(Run run, double least, std::int64_t& work) {
  for (;; work *= 2) {
    double best = run();
    for (int i = 1; i < k_runs; ++i) best = std::min(best, run());
    if (best >= least) return best;
  }
}

}  // namespace

HostProbe::HostProbe(Simd simd, int threads, double seconds)
    : probe_(&probe_for(simd)),
      threads_(threads),
      seconds_(seconds),
      rounds_(k_operations.size(), 0),
      sinks_(16 * static_cast<std::size_t>(threads)) {}

template <class Work>
double HostProbe::time_together(Work work) const {
  openmp::TeamBarrier barrier(threads_);
  double begin = 0.0, end = 0.0;
#pragma omp parallel num_threads(threads_)
  {
    const int thread = omp_get_thread_num();
    barrier.enter(thread);
    barrier.wait(thread);
    if (thread == 0) begin = now();
    work(thread);
    barrier.wait(thread);
    if (thread == 0) end = now();
  }
  return end - begin;
}

double HostProbe::rate(Operation operation) {
  std::int64_t& rounds = rounds_[static_cast<std::size_t>(operation)];
  const auto run = [&] {
    return time_together([&](int thread) {
      sinks_[16 * static_cast<std::size_t>(thread)] = probe_->arithmetic(operation, rounds, 0.0f);
    });
  };
  rounds = std::max<std::int64_t>(rounds, 1000);
  const double best = best_of(run, 0.5 * seconds_, rounds);
  return static_cast<double>(rounds) * probe_->per_round(operation) * probe_->lanes * threads_ / best;
}

float* HostProbe::memory_for(std::size_t share_of_thread) {
  const std::size_t needed = share_of_thread * static_cast<std::size_t>(threads_) + k_step;
  const bool grows = memory_size_ < needed;
  if (grows) memory_.reset(new float[needed]);  // not written to yet
  memory_size_ = std::max(memory_size_, needed);
  const auto misaligned = reinterpret_cast<std::uintptr_t>(memory_.get()) / sizeof(float) % k_step;
  float* first = memory_.get() + (misaligned == 0 ? 0 : k_step - misaligned);
  if (grows)
    time_together([&](int thread) {
      float* begin = first + share_of_thread * static_cast<std::size_t>(thread);
      std::fill(begin, begin + share_of_thread, 1.0f);
    });
  return first;
}

double HostProbe::bandwidth(Stream stream, std::size_t bytes) {
  const std::size_t arrays = stream == Stream::triad ? 3 : 2;
  const std::size_t share =
      std::max<std::size_t>(bytes / sizeof(float) / arrays / static_cast<std::size_t>(threads_) / k_step, 1) * k_step;
  const std::size_t next = share + k_step;  // not a page's length apart, where stores would hold up loads
  float* first = memory_for(arrays * next);
  std::int64_t passes = 1;
  const auto run = [&] {
    return time_together([&](int thread) {
      float* a = first + arrays * next * static_cast<std::size_t>(thread);
      for (std::int64_t pass = 0; pass < passes; ++pass)
        probe_->stream(stream, a, a + next, a + (arrays - 1) * next, share, 0.5f);
    });
  };
  run();  // brings it into the caches it fits into
  const double best = best_of(run, 0.5 * seconds_, passes);
  return static_cast<double>(passes) * static_cast<double>(share) * threads_ *
         static_cast<double>(bytes_per_element(stream)) / best;
}

Bounds HostProbe::measure(std::size_t working_set_bytes) {
  Bounds bounds;
  for (const Operation operation : k_operations) bounds.rates[static_cast<std::size_t>(operation)] = rate(operation);
  bounds.bytes = bandwidth(Stream::copy, working_set_bytes);
  return bounds;
}

}  // namespace squall::bench
