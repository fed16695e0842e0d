#pragma once

namespace squall::app {

/// While it lives, the first Ctrl-C (SIGINT) or SIGTERM only asks: the frame is finished and what was asked for is
/// written. A second one of the same kind ends the process at once.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const;
  /// 128 and the signal's number, as shells have it: k_exit_interrupted or k_exit_terminated.
  int exit_code() const;
};

}  // namespace squall::app
