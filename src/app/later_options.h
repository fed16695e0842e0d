#pragma once

namespace CLI {
class App;
}

namespace squall::app {

/// Options that a later version will have: taken without a word in --help, so that what refuses them can say so.

/// Adds those that the command does not have, with their variables.
void add_later_options(CLI::App& command);
/// `compare` and `sweep` have several runs; a checkpoint holds one.
void add_later_checkpoints(CLI::App& command);

/// These throw UsageError for what the other two added, where it is given.
void refuse_later_options(const CLI::App& command);
void refuse_later_checkpoints(const CLI::App& command);

}  // namespace squall::app
