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
        fmt::format("{} would overwrite {}, which this run is read from; name another place", option, input));
  }
}

struct Target {
  const char* option;
  fs::path path;
};

/// Refuses an option that writes to the same file as one of `others`.
void refuse_twins(const Target& target, const std::vector<Target>& others) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(target.path, error);
  for (const auto& other : others)
    if (fs::weakly_canonical(other.path, error) == path)
      throw UsageError(fmt::format("{} and {} name the same file; give each its own", other.option, target.option));
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
  // A run may replace the checkpoint that it went on from; nothing else may.
  if (!options.checkpoint.empty()) protect("--checkpoint", options.checkpoint, inputs);
  if (!options.restart.empty()) inputs.push_back(options.restart);
  std::vector<Target> targets;
  const auto add = [&](const char* option, const std::string& file) {
    if (file.empty() || file == "-") return;
    refuse_twins({option, file}, targets);
    targets.push_back({option, file});
  };
  add("--json", options.json);
  add("--trace", options.trace);
  for (const auto& file : out_files) targets.push_back({"--out", file});
  for (const auto& target : targets) protect(target.option, target.path, inputs);
  add("--checkpoint", options.checkpoint);
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
