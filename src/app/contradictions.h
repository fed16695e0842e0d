#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/options.h"

namespace squall::app {

/// Whether an option ("--device") stands on the command line; others that have a value have it from a variable.
using IsFlag = std::function<bool(const std::string& option)>;

/// Takes back options from variables that contradict a flag, or a backend that no variable chose. Returns a sentence
/// for each.
std::vector<std::string> drop_contradicted_variables(const IsFlag& is_flag, Options& options);

/// Throws UsageError for an option that belongs to backends which do not take part, and for backends that leave `agree`
/// nothing to compare.
void check_contradictions(const Options& options);

}  // namespace squall::app
