#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "harness/sweep_report.h"
#include "harness/sweep_results.h"

namespace squall::app {

/// The folder of `sweep --out`: report.html, a file per plot, points.csv and sweep.json. Made if missing; files of
/// these names from an earlier sweep are removed as soon as a run has done a frame, and not before. Throws InputError
/// for what cannot be written.
class SweepFolder {
 public:
  /// `begun`: what sweep.json says from the first size on, so that a sweep that is killed says whose points these are.
  SweepFolder(const std::string& path, std::string begun);

  /// Paths in this folder that are the names above, whether there or not.
  static std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder);

  /// Adds a size to points.csv at once, so that it is there whatever happens later.
  void add_points(const std::vector<harness::SweepPoint>& points);
  /// Draws the plots and writes the rest, unless the folder keeps an earlier sweep. Throws DeviceError if gnuplot does
  /// not draw; sweep.json is written before.
  void finish(const harness::SweepResult& result);

 private:
  void begin();
  void write(const std::string& name, const std::string& text) const;

  std::filesystem::path path_;
  std::string begun_json_;
  bool begun_ = false;
  std::vector<harness::SweepPoint> waiting_;  ///< without a frame; not worth earlier results
  std::ofstream points_;
};

}  // namespace squall::app
