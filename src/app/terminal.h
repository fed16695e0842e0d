#pragma once

#include <string>

namespace squall::app {

/// Whether file descriptor 1 or 2 is a terminal.
bool is_terminal(int descriptor);

/// Whether stdout takes colour: a terminal, and NO_COLOR is unset or empty (no-color.org).
bool use_colour();

/// The text in bold or red for a terminal that takes colour; else as it is.
std::string bold(const std::string& text);
std::string red(const std::string& text);

/// 11664 as "11,664".
std::string with_commas(long long value);

}  // namespace squall::app
