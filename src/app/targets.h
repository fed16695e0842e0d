#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.h"
#include "app/workload.h"

namespace squall::app {

/// Refuses, before anything is written, --out, --json, --trace and --checkpoint that would destroy one of `inputs` or
/// what --restart reads, and two options that write to one file, however it is named (UsageError). `out_files`: what
/// the command writes into the folder of --out.
void protect_inputs(const Options& options, std::vector<std::string> inputs,
                    const std::vector<std::filesystem::path>& out_files);
/// The same for a scene: its inputs are its file and its particle files.
void protect_inputs(const Options& options, const Workload& workload,
                    const std::vector<std::filesystem::path>& out_files);
/// The same for the commands that write an OutputFolder.
void protect_inputs(const Options& options, const Workload& workload);

/// Throws InputError if the file of --json or --trace cannot be written; leaves what it holds alone. Folder of --out
/// first.
void check_targets(const Options& options);

}  // namespace squall::app
