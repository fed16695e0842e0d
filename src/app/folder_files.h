#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

namespace squall::app {

/// What an earlier run left in a folder of results must not be lost before there is something to put in its place.
bool any_exists(const std::vector<std::filesystem::path>& files);

/// Tries to write these without changing what they hold. Throws InputError for one that cannot be written.
void check_writable(const std::vector<std::filesystem::path>& files);

/// Throws InputError if what went to `file` so far did not get there.
void check_written(const std::ostream& file, const std::filesystem::path& path);

}  // namespace squall::app
