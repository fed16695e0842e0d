#include "app/terminal.h"

#include <unistd.h>

#include <cstdlib>

namespace squall::app {

bool is_terminal(int descriptor) { return isatty(descriptor) != 0; }

bool use_colour() {
  const char* no_colour = std::getenv("NO_COLOR");
  return is_terminal(STDOUT_FILENO) && (no_colour == nullptr || *no_colour == '\0');
}

std::string bold(const std::string& text) { return use_colour() ? "\x1b[1m" + text + "\x1b[0m" : text; }
std::string red(const std::string& text) { return use_colour() ? "\x1b[31m" + text + "\x1b[0m" : text; }

std::string with_commas(long long value) {
  std::string digits = std::to_string(value);
  const std::size_t first = digits.front() == '-' ? 1 : 0;
  for (std::size_t place = digits.size(); place > first + 3;) digits.insert(place -= 3, ",");
  return digits;
}

}  // namespace squall::app
