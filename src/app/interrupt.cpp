#include "app/interrupt.h"

#include <csignal>

namespace squall::app {

namespace {

// A signal handler reaches nothing but static storage; this is the only one in squall.
volatile std::sig_atomic_t interrupt_requested = 0;

void request_interrupt(int) { interrupt_requested = 1; }

}  // namespace

Interrupt::Interrupt() {
  interrupt_requested = 0;
  struct sigaction action {};
  action.sa_handler = request_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
}

Interrupt::~Interrupt() { std::signal(SIGINT, SIG_DFL); }

bool Interrupt::requested() const { return interrupt_requested != 0; }

}  // namespace squall::app
