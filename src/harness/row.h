#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame_report.h"
#include "core/settings.h"
#include "core/solver.h"
#include "harness/statistics.h"

namespace squall::harness {

/// What one run is: which backend, with which settings, for how long.
struct RunPlan {
  std::string label;  ///< names the run in tables and files: "omp, 2 threads"
  std::string backend;
  Settings settings;
  bool strict = true;  ///< the device promises the same bits as the others (DeviceInfo::bitwise)
  int warm_up_frames = 5;
  int frames = 60;      ///< counted ones
  bool rewind = false;  ///< start over after the warm-up: the counted frames begin at the state that was loaded
  std::optional<double> energy_in_j;  ///< brought in up to that state, if it continues a run; else its own energy
};

/// One counted frame.
struct FrameRecord {
  double time_s = 0.0;  ///< simulated, at the end of the frame
  FrameReport report;
  double cpu_ms = 0.0;                               ///< processor time of the whole process
  std::uint64_t state_hash = 0;                      ///< at the end of the frame
  std::chrono::steady_clock::time_point begin = {};  ///< where the spans of the report count from
};

/// How far apart two states are.
struct Difference {
  std::uint32_t particle = 0;          ///< lowest id that differs
  double max_position_error_dx = 0.0;  ///< in spacings
  double max_velocity_error = 0.0;     ///< m/s
};

/// What one run gave: a line of every table. Times are wall clock; definitions in docs/results.md.
struct Row {
  RunPlan plan;
  SolverInfo solver;
  std::string error;  ///< why the end state is wrong; empty if it is not. Numbers of such a row mean nothing
  bool device_failed = false;
  bool interrupted = false;  ///< ended before its planned frames, without an error

  std::int64_t particles = 0;
  std::uint64_t start_frame = 0;  ///< frames done before this run: above 0 if it continues one
  int frames = 0;                 ///< counted
  std::int64_t steps = 0;
  double simulated_s = 0.0;
  double wall_s = 0.0;  ///< sum of frame_ms
  double realtime_factor = 0.0;
  double fps = 0.0;
  Tail frame_ms, compute_ms, readback_ms, upload_ms;
  double cpu_ms_mean = 0.0;
  double readback_bytes_per_frame = 0.0;         ///< delivered to the caller
  double readback_copied_bytes_per_frame = 0.0;  ///< written to get them there
  int readback_latency_frames = 0;
  std::optional<double> readback_copy_ms;  ///< device time of the delivery per frame, from the profiled run
  std::optional<double> readback_overlap;  ///< share of it beside the frame's other commands, 0 to 1
  double readback_share = 0.0;
  std::optional<double> exposed_readback_ms;  ///< against the same run without read-back; only where that took part
  std::optional<Interval> exposed_readback_interval_ms;
  std::map<std::string, double> phase_ms;  ///< mean per frame, from a separate profiled run
  double particle_steps_per_s = 0.0;
  double pairs_per_s = 0.0;
  double neighbours_mean = 0.0;
  double iterations_mean = 0.0;
  double density_iterations_mean = 0.0, divergence_iterations_mean = 0.0;  ///< of dfsph, per sub-step
  int density_iterations_max = 0, divergence_iterations_max = 0;
  std::int64_t unconverged = 0;         ///< solves that max_iterations cut short
  double light_passes_mean = 0.0;       ///< of dfsph, per sub-step
  std::optional<double> light_pass_ns;  ///< wall clock per particle and light pass, where they are timed
  double density_error_mean = 0.0;
  double density_error_max = 0.0;
  double density_error_worst = 0.0;    ///< largest mean of a frame
  double density_tolerance = 0.0;      ///< of the scene, for dfsph
  std::optional<double> energy_drift;  ///< (E - E_in)/|E_in|; empty if there is no energy to compare with
  std::int64_t clamps = 0;
  std::int64_t lost_particles = 0;
  std::uint64_t state_hash = 0;
  std::optional<double> position_error_dx;  ///< at the end, against the reference backend; only where that took part
};

/// What a profiled run gave: means per frame [ms].
struct Profile {
  std::map<std::string, double> phase_ms;
  double readback_copy_ms = 0.0, readback_hidden_ms = 0.0;
};

/// Fills what follows from a profiled run.
void add_profile(const Profile& profile, Row& row);

/// Fills what follows from the counted frames.
void summarise(const std::vector<FrameRecord>& frames, double frame_duration_s, Row& row);

}  // namespace squall::harness
