#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "app/workload.h"
#include "harness/gauges.h"
#include "harness/run.h"

namespace squall::app {

/// The folder of --out: scene.toml, frames.csv, series.csv, gauges.csv where the scene has gauges and, with
/// --save-every, frame_000000.csv. Made if missing; files of these names from an earlier run are removed as soon as
/// there is a frame to write in their place, and not before; a run that goes on cuts what comes again at once. Throws
/// InputError for what cannot be written.
class OutputFolder {
 public:
  /// The workload must outlive the folder. A run that goes on from `earlier_frames` frames keeps what they left here,
  /// and throws InputError if that is of another scene or of other gauges.
  OutputFolder(const std::string& path, const Workload& workload, std::uint64_t earlier_frames = 0);

  /// Paths in this folder that are the names above, whether there or not; of frame_000000.csv only those there.
  static std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder);

  /// Whether a file's name is that of a saved frame: frame_000000.csv.
  static bool is_frame_file(const std::string& name);

  /// Writes what follows from the frame that the run has just counted.
  void after_frame(const harness::Run& run, int save_every);
  void add_frame(const std::string& label, const harness::FrameRecord& frame);
  /// Hands what was written so far to the system: it outlives this process.
  void flush();
  /// Says so if the disk did not take everything.
  void finish();

 private:
  void check_earlier_scene(const Workload& workload) const;
  void check_earlier_gauges(const Workload& workload) const;
  void begin();
  void remove_old_files() const;
  void open_series();
  void open_gauges(const Scene& scene, Pressure pressure);
  std::ofstream open(const std::string& name) const;
  std::ofstream open_rows(const std::string& name, const std::string& header) const;
  void add_gauges(const harness::Run& run, double time_s);
  void save_particles(const harness::Run& run) const;

  std::filesystem::path path_;
  const Workload& workload_;
  bool begun_ = false;
  std::uint64_t earlier_frames_ = 0;
  double earlier_s_ = 0.0;  ///< what they simulated
  std::ofstream frames_, series_, gauges_file_;
  std::optional<harness::Gauges> gauges_;
};

}  // namespace squall::app
