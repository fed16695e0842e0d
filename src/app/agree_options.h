#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/options.h"

namespace squall::app {

/// Texts of options that `squall agree` alone takes, before they are understood.
struct AgreeTexts {
  std::vector<std::string> backends, simds;
  std::string pressure;
};

/// Adds the command with its options, but for those of output.
CLI::App* add_agree(CLI::App& app, Options& options, AgreeTexts& texts);

/// Throws UsageError for names that there are not.
void understand(const AgreeTexts& texts, Options& options);

}  // namespace squall::app
