#pragma once

namespace squall::app {

/// While it lives, the first Ctrl-C (SIGINT) only asks: the frame is finished and what was asked for is written. A
/// second one ends the process at once.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const;
};

}  // namespace squall::app
