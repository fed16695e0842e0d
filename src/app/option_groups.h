#pragma once

#include <CLI/CLI.hpp>

#include "app/options.h"
#include "app/raw_options.h"

namespace squall::app {

/// Options that several commands have.

/// --json and --quiet.
void add_output_options(CLI::App& command, Options& options);
/// --particles with one size.
void add_particles(CLI::App& command, Options& options);
/// The scene and what changes its water.
void add_water_options(CLI::App& command, Options& options, RawOptions& raw);
/// --simd and --precision.
void add_solver_options(CLI::App& command, RawOptions& raw);
/// --frames and --seconds.
void add_length_options(CLI::App& command, Options& options);
/// How `run` and `compare` measure, and where their results go.
void add_measuring_options(CLI::App& command, Options& options, RawOptions& raw);
void add_checkpoint_options(CLI::App& command, Options& options);
/// Which runs stand side by side; what is taken where nothing is asked for differs between commands.
void add_lists_of_runs(CLI::App& command, Options& options, RawOptions& raw, const char* threads,
                       const char* readbacks);

}  // namespace squall::app
