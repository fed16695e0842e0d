#pragma once

#include <functional>
#include <memory>

#include "harness/row.h"

namespace squall::harness {

/// With Settings::trace, a run keeps the spans of its counted frames until there are this many (about 100 MB).
inline constexpr std::size_t k_max_spans = 1'000'000;

using SolverFactory = std::function<std::unique_ptr<Solver>(const RunPlan& plan)>;

/// One run, advanced frame by frame, so that several can be interleaved. Between frames, untimed, it reads the whole
/// state back, hashes it and holds the positions delivered against it: what a row ends with is checked, never assumed.
class Run {
 public:
  /// The solver holds the particles to start from. Throws InputError for fewer than one counted frame or a negative
  /// warm-up.
  Run(std::unique_ptr<Solver> solver, RunPlan plan);

  const RunPlan& plan() const { return plan_; }
  const Scene& scene() const { return solver_->scene(); }
  SolverInfo solver() const { return solver_->info(); }
  /// After all frames, or after one whose end state is wrong.
  bool done() const;
  /// One frame, warm-up or counted. A device that fails ends the run and is kept for the row.
  void step();
  /// Frames done, warm-up included.
  int steps_done() const { return steps_done_; }
  int steps_planned() const { return plan_.warm_up_frames + plan_.frames; }

  const State& state() const { return state_; }             ///< after the last frame
  std::uint64_t state_hash() const { return state_hash_; }  ///< of that state
  const std::vector<FrameRecord>& frames() const { return frames_; }
  const std::string& error() const { return error_; }
  bool device_failed() const { return device_failed_; }  ///< the error is the machine's; the state is that before it
  double energy_in() const { return energy_in_; }        ///< J: of the start and of all particles added since

  /// What has been measured so far.
  Row row() const;

 private:
  void advance();
  void rewind();
  double energy_of_start() const;
  /// After a wrong end state in a warm-up that is rewound: the counted frames start at once, so that the same frames
  /// are played again and leave their records up to the error.
  void give_up_warm_up();
  void take_state();
  void limit_spans(FrameReport& report);
  void check_end_state(const FrameReport& report);

  std::unique_ptr<Solver> solver_;
  RunPlan plan_;
  State start_, state_;
  double energy_in_ = 0.0;
  std::uint64_t state_hash_ = 0;
  std::vector<FrameRecord> frames_;
  int steps_done_ = 0;
  std::size_t spans_left_ = k_max_spans;
  std::string error_;
  bool device_failed_ = false;
};

/// Called after every frame; false ends the run early, with what was measured until then.
using AfterFrame = std::function<bool(const Run& run)>;

/// Runs to the end of the plan, or until `after_frame` is enough.
Row run_to_end(Run& run, const AfterFrame& after_frame = {});

/// The one primitive: runs a plan to its end.
Row run_once(std::unique_ptr<Solver> solver, const RunPlan& plan, const AfterFrame& after_frame = {});

/// Mean times per frame over a few frames that continue from `state`, after one that is not counted. A run of its own,
/// since measuring phases slows some devices down. Empty for the reference, which has no phases, and for a device that
/// cannot be profiled: its timed frames stand.
Profile profile_run(const SolverFactory& make, RunPlan plan, const State& state);

}  // namespace squall::harness
