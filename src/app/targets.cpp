#include "app/targets.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "app/exit_codes.h"
#include "app/output_folder.h"
#include "core/errors.h"

namespace squall::app {

namespace {

namespace fs = std::filesystem;

void protect(const char* option, const fs::path& target, const std::vector<std::string>& inputs) {
  for (const auto& input : inputs) {
    std::error_code error;
    if (!fs::equivalent(target, input, error) || error) continue;
    throw UsageError(
        fmt::format("{} would overwrite {}, which this scene is read from; name another place", option, input));
  }
}

void check_target(const std::string& target) {
  if (target.empty()) return;
  std::error_code error;
  const auto type = fs::status(target, error).type();
  const bool is_new = type == fs::file_type::not_found;
  // A pipe's reader would take a trial for the end.
  if (!is_new && type != fs::file_type::regular && type != fs::file_type::directory) return;
  if (!std::ofstream(target, std::ios::app))
    throw InputError(target + ": cannot write this file; check the folder's rights and free space");
  if (is_new) fs::remove(target, error);
}

}  // namespace

void protect_inputs(const Options& options, const Workload& workload, const std::vector<fs::path>& out_files) {
  std::vector<std::string> inputs{options.scene};
  for (const auto& file : workload.scene.particle_files) inputs.push_back(file.file);
  if (!options.json.empty() && !options.json_alone()) protect("--json", options.json, inputs);
  if (!options.trace.empty()) protect("--trace", options.trace, inputs);
  std::error_code error;
  if (!options.trace.empty() && !options.json.empty() && !options.json_alone() &&
      fs::weakly_canonical(options.trace, error) == fs::weakly_canonical(options.json, error))
    throw UsageError("--json and --trace name the same file; give each its own");
  for (const auto& file : out_files) protect("--out", file, inputs);
}

void protect_inputs(const Options& options, const Workload& workload) {
  protect_inputs(options, workload,
                 options.out.empty() ? std::vector<fs::path>{} : OutputFolder::own_files(options.out));
}

void check_targets(const Options& options) {
  if (!options.json_alone()) check_target(options.json);
  check_target(options.trace);
}

}  // namespace squall::app
