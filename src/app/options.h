#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/study_options.h"
#include "core/scene.h"
#include "core/settings.h"

namespace squall::app {

enum class Command { devices, run, compare, sweep, agree, study, validate, stress };
enum class Format { squall, google_benchmark };

/// The command line and SQUALL_* variables, checked. Empty or absent: not given.
struct Options {
  Command command = Command::devices;
  std::string scene;
  std::vector<std::string> cases;   ///< validate: files or names; empty: all that come with squall
  std::string expected;             ///< validate: table for a scene; empty: none
  std::optional<double> tolerance;  ///< validate: of that table
  std::vector<std::string> backends;
  std::string device;
  std::vector<int> threads;
  std::optional<Simd> simd;
  std::vector<Simd> simds;  ///< agree: its --simd
  std::optional<Precision> precision;
  std::optional<Pressure> pressure;
  std::vector<Pressure> pressures;  ///< validate, stress, study: only these
  std::vector<Readback> readbacks;
  std::optional<std::int64_t> particles;
  std::vector<std::int64_t> sizes;  ///< sweep: its --particles
  std::optional<int> frames;
  std::optional<double> seconds;
  std::optional<double> dt_max_s;
  std::optional<double> budget_ms;
  std::uint64_t seed = 1;
  bool tune = false;
  std::string tuning;  ///< file with tuned work sizes, or "none"; empty: the one in the cache folder
  std::string out;
  int save_every = 0;      ///< frames; 0: never
  std::string trace;       ///< file; empty: none
  std::string checkpoint;  ///< file; empty: none
  std::optional<double> checkpoint_every_s;
  std::string restart;  ///< file; empty: from the start
  std::string json;     ///< file, or "-" for stdout
  Format format = Format::squall;
  bool quiet = false;
  bool print_scene = false;
  bool quick = false;             ///< validate, stress: coarser scenes, shorter runs
  bool list = false;              ///< validate: says what there is
  std::vector<int> case_numbers;  ///< stress; empty: all
  bool largest_step = false;      ///< stress: looks for it instead of trying the cases
  StudyOptions study;

  bool json_alone() const { return json == "-"; }  ///< stdout holds the JSON and nothing else
};

/// Values of options; throw UsageError for an unknown one and for one that this version does not have.
Pressure parse_pressure(const std::string& text);
Precision parse_precision(const std::string& text);
Simd parse_simd(const std::string& text);
Readback parse_readback(const std::string& text);
std::string parse_backend(const std::string& text);

/// Frames a run takes: --frames, else --seconds, else the scene's duration.
int frames_of(const Options& options, const Scene& scene);

}  // namespace squall::app
