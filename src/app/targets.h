#pragma once

#include <filesystem>
#include <vector>

#include "app/options.h"
#include "app/workload.h"

namespace squall::app {

/// Refuses, before anything is written, --out, --json, --trace and --checkpoint that would destroy the scene file, a
/// particle file of it or what --restart reads, and two of them to one file (UsageError). `out_files`: what the command
/// writes into the folder of
/// --out.
void protect_inputs(const Options& options, const Workload& workload,
                    const std::vector<std::filesystem::path>& out_files);
/// The same for the commands that write an OutputFolder.
void protect_inputs(const Options& options, const Workload& workload);

/// Throws InputError if the file of --json or --trace cannot be written; leaves what it holds alone. Folder of --out
/// first.
void check_targets(const Options& options);

}  // namespace squall::app
