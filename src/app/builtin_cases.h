#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/validation/case.h"

namespace squall::app {

/// Files below validation/ by their path in it, as they were when the command was built.
const std::map<std::string, std::string>& embedded_case_files();

/// Names of the cases that come with squall, in the order in which they run: those of their files.
std::vector<std::string> builtin_case_names();

/// One of them. Throws InputError for another name.
harness::Case builtin_case(const std::string& name);

}  // namespace squall::app
