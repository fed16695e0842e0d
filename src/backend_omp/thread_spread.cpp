#include "backend_omp/thread_spread.h"

#ifdef __linux__
#include <sched.h>
#endif

namespace squall::openmp {

ThreadSpread::ThreadSpread(int threads)
    : threads_(threads), seats_(std::make_unique<Seat[]>(static_cast<std::size_t>(threads))) {}

#ifdef __linux__

void ThreadSpread::settle(int thread) {
  if (threads_ == 1) return;
  const int processor = sched_getcpu();
  seats_[static_cast<std::size_t>(thread)].processor.store(processor, std::memory_order_relaxed);
  for (int other = 0; other < thread; ++other) {
    if (seats_[static_cast<std::size_t>(other)].processor.load(std::memory_order_relaxed) != processor) continue;
    move_away(thread);
    return;
  }
}

void ThreadSpread::move_away(int thread) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  cpu_set_t elsewhere = allowed;
  for (int other = 0; other < threads_; ++other) {
    const int processor = seats_[static_cast<std::size_t>(other)].processor.load(std::memory_order_relaxed);
    if (processor >= 0 && processor < CPU_SETSIZE) CPU_CLR(static_cast<std::size_t>(processor), &elsewhere);
  }
  if (CPU_COUNT(&elsewhere) == 0 || sched_setaffinity(0, sizeof elsewhere, &elsewhere) != 0) return;
  seats_[static_cast<std::size_t>(thread)].processor.store(sched_getcpu(), std::memory_order_relaxed);
  sched_setaffinity(0, sizeof allowed, &allowed);
}

#else

void ThreadSpread::settle(int) {}
void ThreadSpread::move_away(int) {}

#endif

}  // namespace squall::openmp
