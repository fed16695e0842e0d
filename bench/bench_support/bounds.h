#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "bench_support/probe.h"
#include "core/settings.h"

namespace squall::bench {

/// How fast a machine, or a part of it, can go at best.
struct Bounds {
  double rates[k_operations.size()] = {};  ///< operations per second by Operation, every lane counted
  double bytes = 0.0;                      ///< per second, copied within the working set asked for

  double rate(Operation operation) const { return rates[static_cast<std::size_t>(operation)]; }
};

/// Measures the processor with one instruction set and so many threads, each probe the best of a few short runs: what
/// else the machine does can only make it look slower.
class HostProbe {
 public:
  /// seconds: of one run of one probe.
  HostProbe(Simd simd, int threads, double seconds);

  /// Operations per second, all threads and lanes together.
  double rate(Operation operation);
  /// Bytes per second over arrays of so many bytes in all, shared out among the threads.
  double bandwidth(Stream stream, std::size_t bytes);
  Bounds measure(std::size_t working_set_bytes);

 private:
  /// Seconds that work(thread) takes on all threads together, from a common start.
  template <class Work>
  double time_together(Work work) const;
  /// Arrays for the streams, each thread's share touched first by that thread. Aligned to cache lines.
  float* memory_for(std::size_t share_of_thread);

  const Probe* probe_;
  int threads_;
  double seconds_;
  std::vector<std::int64_t> rounds_;  ///< by Operation: what fills `seconds_`
  std::unique_ptr<float[]> memory_;
  std::size_t memory_size_ = 0;
  std::vector<float> sinks_;  ///< per thread
};

}  // namespace squall::bench
