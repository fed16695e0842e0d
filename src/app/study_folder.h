#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/study/study_report.h"

namespace squall::app {

/// The folder of `study --out`: runs.jsonl (a line per run that is done: what a later start of the study need not run
/// again), scenes/ (a scene file per setting), report.html, a file per plot, study.csv and study.json. Made if missing.
class StudyFolder {
 public:
  /// Throws InputError, before anything is touched, for a folder that holds the study of another scene, the results of
  /// another command, or runs of another kind; and for what cannot be written.
  StudyFolder(const std::string& path, const harness::SceneInfo& scene);

  /// Paths in this folder that are the names above, whether there or not; of scenes none.
  static std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder);

  /// Runs of earlier starts; a line that was cut off is left out.
  std::vector<harness::Record> take_earlier_runs() { return std::move(earlier_); }

  /// Adds a run at once, so that it is there whatever happens later.
  void keep(const harness::Record& record);

  /// Writes the scene of a run; returns its path.
  std::string write_scene(const std::string& name, const Scene& scene, Pressure pressure);

  /// Draws the plots and writes the rest. Throws DeviceError if gnuplot does not draw; study.json is written before.
  void finish(const harness::StudyResult& result);

 private:
  void read_runs();
  void open_runs();
  void write(const std::filesystem::path& name, const std::string& text) const;

  std::filesystem::path path_;
  harness::SceneInfo scene_;
  std::vector<harness::Record> earlier_;
  std::optional<std::string> whole_runs_;  ///< what earlier_ was read from, where a line behind it was cut off
  std::ofstream runs_;
};

}  // namespace squall::app
