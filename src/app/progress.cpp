#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/terminal.h"

namespace squall::app {

Progress::Progress(bool quiet, std::string what)
    : shown_(!quiet && is_terminal(STDERR_FILENO)), what_(std::move(what)), start_(Clock::now()), last_(start_) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(int done, int total) {
  if (total <= 0) return;
  const double share = static_cast<double>(done) / total;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left_s = done > 0 ? elapsed_s * (1.0 - share) / share : 0.0;
  draw(share, fmt::format("{} of {} frames", done, total), left_s);
}

void Progress::update(double share, const std::string& doing, double left_s) { draw(share, doing, left_s); }

void Progress::draw(double share, const std::string& doing, double left_s) {
  constexpr std::chrono::milliseconds k_redraw_after{100};
  const auto now = Clock::now();
  if (!shown_ || (now - last_ < k_redraw_after && share < 1.0)) return;
  last_ = now;
  constexpr int k_width = 30;
  const auto filled = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * k_width);
  const std::string bar = std::string(filled, '#') + std::string(k_width - filled, '.');
  const auto seconds = static_cast<int>(std::min(left_s + 0.5, 359999.0));
  const std::string line = fmt::format("\r{} [{}] {:3.0f} %  {}, {}:{:02} left\x1b[K", what_, bar, 100.0 * share, doing,
                                       seconds / 60, seconds % 60);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace squall::app
