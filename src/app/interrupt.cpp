#include "app/interrupt.h"

#include <csignal>

#include "app/exit_codes.h"

namespace squall::app {

namespace {

constexpr int k_signals[] = {SIGINT, SIGTERM};

// A signal handler reaches nothing but static storage; this is the only one in squall. The first signal, or 0.
volatile std::sig_atomic_t requested_signal = 0;

void request_interrupt(int signal) {
  if (requested_signal == 0) requested_signal = signal;
}

}  // namespace

Interrupt::Interrupt() {
  requested_signal = 0;
  struct sigaction action {};
  action.sa_handler = request_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  for (const int signal : k_signals) sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() {
  for (const int signal : k_signals) std::signal(signal, SIG_DFL);
}

bool Interrupt::requested() const { return requested_signal != 0; }

int Interrupt::exit_code() const { return requested_signal == SIGTERM ? k_exit_terminated : k_exit_interrupted; }

}  // namespace squall::app
