#pragma once

#include <optional>
#include <string>

#include "harness/tuning.h"

namespace squall::app {

/// The file that remembers which work sizes were fastest: a first line with its version, then a line per device,
/// driver, kind of scene and size class. It is a cache: one that is missing, damaged or of another version holds
/// nothing.
class TuningTable {
 public:
  /// Where it lies: $XDG_CACHE_HOME/squall/tuning.tsv or ~/.cache/squall/tuning.tsv; empty if neither variable is set.
  static std::string default_path();

  explicit TuningTable(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }

  /// Whether the file is one that find() reads: there, whole and of this version.
  bool is_there() const;

  std::optional<harness::WorkChoice> find(const std::string& key) const;

  /// Adds or replaces. Throws InputError if the file cannot be written; the old one is then as it was.
  void store(const std::string& key, const harness::WorkChoice& choice) const;

 private:
  std::string path_;
};

/// What a choice depends on. The size class is the power of two below the number of particles.
std::string tuning_key(const DeviceInfo& device, const Scene& scene, const Settings& settings, std::size_t particles);

}  // namespace squall::app
