#include "app/checkpoints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/notes.h"
#include "app/plans.h"
#include "core/errors.h"

namespace squall::app {

namespace {

/// Frames left of the scene's duration.
int frames_left(const Options& options, const Workload& workload, const Checkpoint& checkpoint) {
  const int all = frames_of(options, workload.scene);
  const std::uint64_t done = checkpoint.state.clock.frame;
  if (done >= static_cast<std::uint64_t>(all))
    throw InputError(fmt::format(
        "{}: nothing is left to do: it has {} frames, the scene's duration_s = {} are {}; add --frames N for N more",
        options.restart, done, workload.scene.time.duration_s, all));
  return all - static_cast<int>(done);
}

void note_precision(const Options& options, const harness::RunPlan& plan, const Checkpoint& checkpoint) {
  if (checkpoint.precision == plan.settings.precision) return;
  print_notes({fmt::format("{} was computed in {} precision and goes on in {}: not to the same bits", options.restart,
                           to_string(checkpoint.precision), to_string(plan.settings.precision))},
              options.quiet);
}

}  // namespace

std::optional<Checkpoint> take_restart(const Options& options, const Workload& workload, harness::RunPlan& plan) {
  if (options.restart.empty()) return std::nullopt;
  Checkpoint checkpoint = read_checkpoint(options.restart);
  check_origin(checkpoint, workload.scene, plan.settings, options.restart);
  if (!options.frames && !options.seconds) plan.frames = frames_left(options, workload, checkpoint);
  plan.energy_in_j = checkpoint.energy_in_j;
  note_precision(options, plan, checkpoint);
  return checkpoint;
}

Checkpoints::Checkpoints(const Options& options, const Workload& workload, const harness::RunPlan& plan)
    : file_(options.checkpoint),
      quiet_(options.quiet),
      scene_text_(checkpoint_scene_text(workload.scene, plan.settings.pressure)),
      settings_(plan.settings) {
  if (options.checkpoint_every_s) {
    const double frames = std::round(*options.checkpoint_every_s * workload.scene.time.frame_rate_hz);
    every_ = static_cast<std::uint64_t>(std::clamp(frames, 1.0, 1e9));
  }
  const int number_bytes = settings_.precision == Precision::single_precision ? 4 : 8;
  largest_ = largest_checkpoint(workload.scene, settings_.pressure, number_bytes);
  claim_space();
}

bool Checkpoints::is_due(const harness::Run& run) const {
  return every_ > 0 && !run.frames().empty() && run.error().empty() && run.state().clock.frame % every_ == 0;
}

void Checkpoints::after_frame(const harness::Run& run) {
  if (!is_due(run)) return;
  try {
    write(run);
    if (!run.done()) claim_space();  // a disk that fills up meanwhile does not take the next one
    failing_ = false;
  } catch (const InputError& error) {
    if (!failing_) print_notes({fmt::format("{}; the run goes on and tries again", error.what())}, quiet_);
    failing_ = true;
  }
}

void Checkpoints::finish(const harness::Run& run) {
  const bool sound = run.error().empty() || run.device_failed();
  if (!sound) return;
  if (run.frames().empty()) {
    print_notes({fmt::format("{} is not written: no frame was completed", file_.path())}, quiet_);
    return;
  }
  if (written_ != run.state().clock.frame) write(run);
}

void Checkpoints::write(const harness::Run& run) {
  Checkpoint checkpoint;
  checkpoint.scene_text = scene_text_;
  checkpoint.pressure = settings_.pressure;
  checkpoint.precision = settings_.precision;
  checkpoint.seed = settings_.seed;
  checkpoint.energy_in_j = run.energy_in();
  checkpoint.state = run.state();
  const std::string bytes = encode_checkpoint(checkpoint);
  file_.write(bytes);
  written_ = run.state().clock.frame;
}

}  // namespace squall::app
