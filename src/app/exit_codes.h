#pragma once

#include <stdexcept>

namespace squall::app {

/// What the process tells its caller (README.md).
enum ExitCode {
  k_exit_fine = 0,
  k_exit_internal = 1,
  k_exit_usage = 2,
  k_exit_input = 3,     ///< scene, checkpoint or output file
  k_exit_device = 4,    ///< missing or failed
  k_exit_disagree = 5,  ///< results that must be equal are not
  k_exit_unstable = 6,  ///< not finite, lost particles
  k_exit_budget = 7,
  k_exit_interrupted = 130,  ///< Ctrl-C; what was asked for is written
  k_exit_terminated = 143,   ///< SIGTERM; likewise
};

/// A command line that cannot be carried out.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace squall::app
