#pragma once

#include <string>

namespace squall {

/// The whole file. Throws InputError with the path and the reason if it cannot be read. Private to core.
std::string read_text_file(const std::string& path);

}  // namespace squall
