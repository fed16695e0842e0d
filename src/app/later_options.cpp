#include "app/later_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/exit_codes.h"
#include "app/option_adding.h"

namespace squall::app {

namespace {

constexpr const char* k_later_options[] = {"--fast-math", "--tolerance", "--max-error"};
constexpr const char* k_checkpoint_options[] = {"--checkpoint", "--checkpoint-every", "--restart"};

}  // namespace

void add_later_options(CLI::App& command) {
  for (const char* name : k_later_options) {
    if (command.get_option_no_throw(name) != nullptr) continue;  // this command has it
    // An empty group hides the option from --help.
    command.add_option(name)->expected(0, 1)->group("")->envname(variable_of(name));
  }
}

void add_later_checkpoints(CLI::App& command) {
  for (const char* name : k_checkpoint_options) command.add_option(name)->expected(0, 1)->group("");
}

void refuse_later_checkpoints(const CLI::App& command) {
  for (const char* name : k_checkpoint_options)
    if (command.get_option(name)->count() > 0)
      throw UsageError(fmt::format("{} of {} is not in this version; run has it", name, command.get_name()));
}

void refuse_later_options(const CLI::App& command) {
  for (const char* name : k_later_options)
    if (const auto* option = command.get_option(name); option->get_group().empty() && option->count() > 0)
      throw UsageError(fmt::format("{} is not in this version", name));
}

}  // namespace squall::app
