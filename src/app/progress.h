#pragma once

#include <chrono>
#include <string>

namespace squall::app {

/// A bar with the time left on stderr; silent where stderr is no terminal or --quiet is set. Erased when it goes.
class Progress {
 public:
  Progress(bool quiet, std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(int done, int total);
  /// Takes the bar away until the next update, for other output.
  void clear();
  /// For work that is not all frames alike: the share done in [0, 1], what is being done, seconds left.
  void update(double share, const std::string& doing, double left_s);

 private:
  void draw(double share, const std::string& doing, double left_s);
  using Clock = std::chrono::steady_clock;
  bool shown_;
  std::string what_;
  Clock::time_point start_, last_;
};

}  // namespace squall::app
