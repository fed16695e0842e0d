#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/workload.h"
#include "harness/run.h"

namespace squall::app {

/// The folder of --out: scene.toml, frames.csv, series.csv and, with --save-every, frame_000000.csv. Made if missing;
/// files of these names from an earlier run are removed. Throws InputError for what cannot be written.
class OutputFolder {
 public:
  OutputFolder(const std::string& path, const Workload& workload);

  /// Paths in this folder that are the names above, whether there or not; of frame_000000.csv only those there.
  static std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder);

  /// Writes what follows from the frame that the run has just counted.
  void after_frame(const harness::Run& run, int save_every);
  void add_frame(const std::string& label, const harness::FrameRecord& frame);
  /// Says so if the disk did not take everything.
  void finish();

 private:
  std::ofstream open(const std::string& name) const;
  static void check(const std::ofstream& file, const std::filesystem::path& path);
  void save_particles(const harness::Run& run) const;

  std::filesystem::path path_;
  std::ofstream frames_, series_;
};

}  // namespace squall::app
