#pragma once

#include <optional>

#include "app/options.h"

namespace squall::app {

/// Reads the command line and the SQUALL_* variables; flags win. Prints help or version on stdout where asked and
/// returns nothing then. Throws UsageError for everything that cannot be carried out.
std::optional<Options> parse_options(int argc, char** argv);

}  // namespace squall::app
