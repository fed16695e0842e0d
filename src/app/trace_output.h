#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "harness/trace_json.h"

namespace squall::app {

/// Writes the file of --trace, if there is one. Returns what a reader must know, a sentence each. Throws InputError for
/// a file that cannot be written.
std::vector<std::string> write_trace(const Options& options, const std::vector<harness::TracedRun>& runs);

}  // namespace squall::app
