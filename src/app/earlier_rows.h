#pragma once

#include <filesystem>
#include <string>

namespace squall::app {

/// Cuts a CSV file of results, written by the run that is continued, back to its whole rows with time_s <= `time_s`; as
/// one step, so that a process that dies leaves the old file or the new. False if there is no such file. Throws
/// InputError if its first line is not `header` (which has a column time_s and ends in \n): another version wrote it.
bool keep_rows_until(const std::filesystem::path& file, const std::string& header, double time_s);

}  // namespace squall::app
