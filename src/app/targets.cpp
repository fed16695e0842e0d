#include "app/targets.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "app/exit_codes.h"
#include "app/output_folder.h"
#include "core/errors.h"

namespace squall::app {

namespace {

namespace fs = std::filesystem;

void protect(const std::string& option, const fs::path& target, const std::vector<std::string>& inputs) {
  for (const auto& input : inputs) {
    std::error_code error;
    if (!fs::equivalent(target, input, error) || error) continue;
    throw UsageError(
        fmt::format("{} would overwrite {}, which this run is read from; name another place", option, input));
  }
}

struct Target {
  std::string option;
  fs::path path;
};

/// Where a path leads, however it is written and whether anything is there or not.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : place;
}

bool are_one_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return place_of(a) == place_of(b) || (fs::equivalent(a, b, error) && !error);
}

/// Refuses an option that writes to the same file as one of `others`.
void refuse_twins(const Target& target, const std::vector<Target>& others) {
  for (const auto& other : others)
    if (are_one_file(other.path, target.path))
      throw UsageError(fmt::format("{} and {} name the same file; give each its own", other.option, target.option));
}

bool writes_tuning(const Options& options) {
  return options.tune && !options.tuning.empty() && options.tuning != "none";
}

/// Files of options that stand for a frame in the folder of --out, written or to come.
std::vector<fs::path> frame_files_among(const Options& options) {
  std::vector<fs::path> files;
  for (const std::string& file : {options.json, options.trace, options.checkpoint}) {
    const fs::path place = place_of(file);
    if (!file.empty() && place.parent_path() == place_of(fs::path(options.out) / "a file").parent_path() &&
        OutputFolder::is_frame_file(place.filename().string()))
      files.push_back(place);
  }
  return files;
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

void protect_inputs(const Options& options, std::vector<std::string> inputs, const std::vector<fs::path>& out_files) {
  // A run may replace the checkpoint that it went on from, and the table it tunes with; nothing else may.
  if (!options.checkpoint.empty()) protect("--checkpoint", options.checkpoint, inputs);
  if (!options.restart.empty()) inputs.push_back(options.restart);
  std::vector<Target> targets;
  for (const auto& file : out_files) targets.push_back({"--out", file});
  const auto add = [&](const char* option, const std::string& file) {
    if (file.empty() || file == "-") return;
    refuse_twins({option, file}, targets);
    targets.push_back({option, file});
  };
  add("--json", options.json);
  add("--trace", options.trace);
  for (const auto& target : targets) protect(target.option, target.path, inputs);
  if (writes_tuning(options)) add("--tuning", options.tuning);
  add("--checkpoint", options.checkpoint);
  if (!options.checkpoint.empty()) refuse_twins({"--checkpoint's FILE.part", options.checkpoint + ".part"}, targets);
}

void protect_inputs(const Options& options, const Workload& workload, const std::vector<fs::path>& out_files) {
  std::vector<std::string> inputs{options.scene};
  for (const auto& file : workload.scene.particle_files) inputs.push_back(file.file);
  protect_inputs(options, std::move(inputs), out_files);
}

void protect_inputs(const Options& options, const Workload& workload) {
  std::vector<fs::path> out_files;
  if (!options.out.empty()) {
    out_files = OutputFolder::own_files(options.out);
    for (auto& file : frame_files_among(options)) out_files.push_back(std::move(file));
  }
  protect_inputs(options, workload, out_files);
}

void check_targets(const Options& options) {
  if (!options.json_alone()) check_target(options.json);
  check_target(options.trace);
}

}  // namespace squall::app
