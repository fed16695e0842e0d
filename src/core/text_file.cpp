#include "core/text_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/errors.h"

namespace squall {

std::string read_text_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(path + ": cannot be read: it is a folder");
  // Some devices never end; pipes, which a shell makes of a command, do.
  if (std::filesystem::is_character_file(path, ignored) || std::filesystem::is_block_file(path, ignored))
    throw InputError(path + ": cannot be read: it is a device");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read: " + std::generic_category().message(errno));
  std::ostringstream text;
  text << file.rdbuf();
  if (text.bad()) throw std::bad_alloc();
  if (file.bad()) throw InputError(path + ": cannot be read to its end");
  return std::move(text).str();
}

}  // namespace squall
