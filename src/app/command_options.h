#pragma once

#include <CLI/CLI.hpp>

#include "app/options.h"
#include "app/raw_options.h"

namespace squall::app {

/// These add a command with all its options, those of later versions included. What they refer to must outlive the
/// parser.
CLI::App* add_run(CLI::App& app, Options& options, RawOptions& raw);
CLI::App* add_compare(CLI::App& app, Options& options, RawOptions& raw);
CLI::App* add_sweep(CLI::App& app, Options& options, RawOptions& raw);
CLI::App* add_validate(CLI::App& app, Options& options, RawOptions& raw);
CLI::App* add_stress(CLI::App& app, Options& options, RawOptions& raw);
CLI::App* add_study(CLI::App& app, Options& options, RawOptions& raw);

}  // namespace squall::app
