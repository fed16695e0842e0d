#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "app/checks.h"
#include "core/settings.h"

namespace squall::app {

/// --dt-max becomes SQUALL_DT_MAX.
inline std::string variable_of(std::string option) {
  option.erase(0, 2);
  std::transform(option.begin(), option.end(), option.begin(),
                 [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::toupper(c)); });
  return "SQUALL_" + option;
}

/// Every option has its variable, and a value.
template <class Value>
CLI::Option* add(CLI::App& command, const std::string& name, Value& value, const std::string& help) {
  return command.add_option(name, value, help)->envname(variable_of(name))->check(not_empty());
}

/// --pressure with one solver.
inline void add_pressure(CLI::App& command, std::string& text) {
  const std::string help = "wcsph, mueller or dfsph; else what the scene says, else ";
  add(command, "--pressure", text, help + to_string(Settings{}.pressure))->type_name("NAME");
}

/// Makes an option take several values, separated by commas or by naming it again.
inline CLI::Option* list(CLI::Option* option, const char* name) {
  return option->delimiter(',')->allow_extra_args(false)->take_all()->type_name(name);
}

}  // namespace squall::app
