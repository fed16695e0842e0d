#pragma once

#include <atomic>
#include <memory>

namespace squall::openmp {

/// Keeps the threads of a team off each other's processors. A kernel that wakes a thread while the processors are idle
/// may put it on the waker's own: in a virtual machine an idle processor looks preempted. Two threads of a team that
/// wait for each other there take turns instead of running side by side, for milliseconds. The second one is moved
/// once, and its affinity left as it was. Does nothing where threads are bound, or outnumber the processors, or outside
/// Linux.
class ThreadSpread {
 public:
  explicit ThreadSpread(int threads);

  /// For each thread to call when it starts on a frame and when it has slept.
  void settle(int thread);

 private:
  void move_away(int thread);

  struct alignas(64) Seat {
    std::atomic<int> processor{-1};
  };
  int threads_;
  std::unique_ptr<Seat[]> seats_;
};

}  // namespace squall::openmp
