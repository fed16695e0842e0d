#include "app/folder_files.h"

#include <algorithm>
#include <fstream>

#include "core/errors.h"

namespace squall::app {

bool any_exists(const std::vector<std::filesystem::path>& files) {
  std::error_code error;
  return std::any_of(files.begin(), files.end(),
                     [&](const auto& file) { return std::filesystem::exists(file, error); });
}

void check_writable(const std::vector<std::filesystem::path>& files) {
  for (const auto& file : files) {
    std::error_code error;
    const bool is_new = !std::filesystem::exists(file, error);
    check_written(std::ofstream(file, std::ios::app), file);
    if (is_new) std::filesystem::remove(file, error);
  }
}

void check_written(const std::ostream& file, const std::filesystem::path& path) {
  if (!file) throw InputError(path.string() + ": cannot write this file; check the folder's rights and free space");
}

}  // namespace squall::app
