#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "harness/study/study_report.h"

namespace squall::app {

/// The folder of `study --out`: runs.jsonl (a line per run that is done: what a later start of the study need not run
/// again), scenes/ (a scene file per setting), report.html, a file per plot, study.csv and study.json. Made if missing.
class StudyFolder {
 public:
  /// Throws InputError for what cannot be written.
  explicit StudyFolder(const std::string& path);

  /// Paths in this folder that are the names above, whether there or not; of scenes none.
  static std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder);

  /// Runs of earlier starts; a line that was cut off is left out. Throws InputError for a file of another kind.
  std::vector<harness::Record> earlier_runs();

  /// Adds a run at once, so that it is there whatever happens later.
  void keep(const harness::Record& record);

  /// Writes the scene of a run; returns its path.
  std::string write_scene(const std::string& name, const Scene& scene, Pressure pressure);

  /// Draws the plots and writes the rest. Throws DeviceError if gnuplot does not draw; study.json is written before.
  void finish(const harness::StudyResult& result);

 private:
  void write(const std::filesystem::path& name, const std::string& text) const;

  std::filesystem::path path_;
  std::ofstream runs_;
};

}  // namespace squall::app
