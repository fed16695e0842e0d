#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "core/errors.h"
#include "core/fields.h"
#include "core/frame_plan.h"
#include "core/frame_report.h"
#include "core/particles.h"
#include "core/positions_view.h"
#include "core/scene.h"
#include "core/settings.h"

namespace squall {

/// What the caller wants to read after a frame.
enum class Delivery { nothing, positions };

/// Everything that continues a run: load then run equals run, bit for bit, on every backend.
struct State {
  Particles particles;
  Clock clock;
};

/// What runs the solver: for reports and tables.
struct SolverInfo {
  std::string backend;             ///< "reference", "omp" or "opencl"
  std::string device;              ///< name of the processor or device
  std::string simd;                ///< "scalar", "avx2", "avx512"; OpenCL: "scalar", "float8", "float16"
  int threads = 1;                 ///< threads or compute units used; 0 if the device does not say
  std::string build_options = {};  ///< what kernels were compiled with at run time; empty where nothing is
  double setup_ms = 0;             ///< building kernels and the like, not part of any frame
};

/// One solver for one scene.
///
/// The rule about blocking: every call returns when its effect is complete; nothing is in flight between calls.
/// Input is checked here, once, for every backend. A solver is used by one thread at a time; different solvers are
/// independent of each other.
class Solver {
 public:
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  const Scene& scene() const { return scene_; }
  const Settings& settings() const { return settings_; }
  const Clock& clock() const { return clock_; }
  virtual SolverInfo info() const = 0;

  /// Starts over from these particles at frame 0. Not finite or far away ones are lost (and counted), whatever the
  /// backend. Throws InputError for arrays of different length, a repeated id, or more particles than there is room
  /// for.
  void load(Particles particles);

  /// Adds particles at the end of the order, between two frames; ids are given by the solver, in this order.
  /// `velocities` belong to the current time. Throws InputError like load().
  void append(Particles particles);

  /// One frame: rain, plan, sub-steps, delivery; of a frame under way, what is left of it. Throws DeviceError if the
  /// device fails.
  const FrameReport& advance(Delivery delivery = Delivery::positions);

  /// The next sub-step alone, to look into a frame: to the same bits as advance(), which does it faster. Delivers
  /// nothing; the report is of this sub-step. Throws like advance().
  const FrameReport& advance_substep();

  /// What the last advance() delivered; empty after Delivery::nothing. With Readback::async, the state that the last
  /// advance() began with: of the frame before, or what was loaded.
  PositionsView positions() const { return positions_; }

  /// Everything, copied to the host; not timed.
  State state();

  /// Continues from a state, of this or any other backend, also from within a frame.
  void restore(const State& state);

  /// Densities, pressures and neighbours of the last sub-step, copied to the host; empty after load() and restore().
  Fields fields();

  const FrameReport& report() const { return report_; }

 protected:
  Solver(Scene scene, Settings settings);

  const Params<double>& params() const { return params_; }
  const std::vector<Box<double>>& boxes() const { return boxes_; }
  const std::vector<HeldGroup>& held_groups() const { return held_groups_; }
  std::size_t capacity() const { return capacity_; }  ///< particles there must be room for
  /// When the frame that is under way was asked for: where the spans of its report count from.
  std::chrono::steady_clock::time_point frame_start() const { return frame_start_; }

 private:
  /// Replaces all particles, keeping their order. At most capacity().
  virtual void do_load(const Particles& particles) = 0;
  /// Adds particles behind all others. Sum at most capacity().
  virtual void do_append(const Particles& particles) = 0;
  /// Runs the sub-steps of the plan and delivers positions if asked. Fills the report's counts, maxima, statistics,
  /// phase_ms, upload_ms, readback_ms and what else is said of delivery, but for readback_bytes.
  virtual void do_advance(const FramePlan& plan, Delivery delivery, FrameReport& report) = 0;
  /// Where the last do_advance delivered to; `frame` is filled in by the caller.
  virtual PositionsView do_positions() = 0;
  /// All particles in their current order.
  virtual Particles do_download() = 0;
  /// Of the last sub-step, which there has been; neighbours as Substep::statistics asked for them.
  virtual Fields do_fields() = 0;

  const FrameReport& advance_part(int most_substeps, Delivery delivery);
  void rain();
  void finish_clock(const FramePlan& plan, int substeps_of_frame);
  void append_ready(const Particles& particles);
  void finish_report(const FramePlan& plan);
  void note_host_span(const char* name, double begin_ms, double end_ms);

  Scene scene_;
  Settings settings_;
  Params<double> params_;
  std::vector<Box<double>> boxes_;
  std::vector<HeldGroup> held_groups_;
  std::size_t capacity_ = 0;
  std::size_t count_ = 0;
  Clock clock_;
  FrameReport report_;
  std::chrono::steady_clock::time_point frame_start_;
  PositionsView positions_;
};

}  // namespace squall
