#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "backend_omp/thread_spread.h"

namespace squall::openmp {

/// A barrier for the threads of one team. It spins for a fraction of a millisecond and then sleeps. OpenMP runtimes
/// spin for many milliseconds, which stalls the team whenever another process has one of its cores. Where one has,
/// sleeping at once is as bad: the thread on the shared core gives it away while it waits for another that is waking
/// up, and gets it back only when the other process has had its turn.
class TeamBarrier {
 public:
  explicit TeamBarrier(int threads) : threads_(threads), spread_(threads) {}

  int threads() const { return threads_; }
  /// Between frames: how many threads the next one has, at most as many as at the start.
  void resize(int threads) { threads_ = threads; }

  /// For each thread to call before its first wait() of a frame.
  void enter(int thread) { spread_.settle(thread); }

  /// Returns when all threads of the team have called it, each with its number; what they wrote before is then visible
  /// to all.
  void wait(int thread) {
    const std::uint32_t phase = phase_.load(std::memory_order_acquire);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
      arrived_.store(0, std::memory_order_relaxed);
      phase_.fetch_add(1, std::memory_order_release);
      phase_.notify_all();
      return;
    }
    const auto deadline = std::chrono::steady_clock::now() + k_spin_time;
    do {
      for (int spin = 0; spin < k_spins_per_look; ++spin) {
        if (phase_.load(std::memory_order_acquire) != phase) return;
        pause();
      }
    } while (std::chrono::steady_clock::now() < deadline);
    while (phase_.load(std::memory_order_acquire) == phase) phase_.wait(phase, std::memory_order_acquire);
    spread_.settle(thread);
  }

 private:
  /// Longer than a sleeping thread takes to wake up (some 100 us in a virtual machine).
  static constexpr std::chrono::microseconds k_spin_time{250};
  static constexpr int k_spins_per_look = 64;  ///< at the clock

  static void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }

  int threads_;
  ThreadSpread spread_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<std::uint32_t> phase_{0};
};

}  // namespace squall::openmp
