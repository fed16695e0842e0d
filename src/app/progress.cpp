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

Progress::~Progress() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(int done, int total) {
  constexpr std::chrono::milliseconds k_redraw_after{100};
  const auto now = Clock::now();
  if (!shown_ || total <= 0 || (now - last_ < k_redraw_after && done < total)) return;
  last_ = now;
  const double share = static_cast<double>(done) / total;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const auto left_s = static_cast<int>(done > 0 ? elapsed_s * (1.0 - share) / share + 0.5 : 0.0);
  constexpr int k_width = 30;
  const auto filled = static_cast<std::size_t>(share * k_width);
  const std::string bar = std::string(filled, '#') + std::string(k_width - filled, '.');
  const std::string line = fmt::format("\r{} [{}] {:3.0f} %  {} of {} frames, {}:{:02} left\x1b[K", what_, bar,
                                       100.0 * share, done, total, left_s / 60, left_s % 60);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace squall::app
