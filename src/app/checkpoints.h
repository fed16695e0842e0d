#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/options.h"
#include "app/workload.h"
#include "core/checkpoint.h"
#include "core/checkpoint_file.h"
#include "harness/run.h"

namespace squall::app {

/// The checkpoint of --restart, if there is one, and what of the plan follows from it: where it starts and, unless
/// --frames or --seconds say so, how many frames are left of the scene. Throws InputError for a file that cannot be
/// used, or one that leaves nothing to do.
std::optional<Checkpoint> take_restart(const Options& options, const Workload& workload, harness::RunPlan& plan);

/// Writes --checkpoint: every --checkpoint-every simulated seconds and at the end.
class Checkpoints {
 public:
  /// Claims the space. Throws InputError for a place that cannot be written.
  Checkpoints(const Options& options, const Workload& workload, const harness::RunPlan& plan);

  /// Whether after_frame() will write.
  bool is_due(const harness::Run& run) const;
  /// Writes if it is due. A failure is a note, once in a row: the file before it is still there, and the run goes on.
  void after_frame(const harness::Run& run);
  /// Writes the last state that is sound, if it is not written yet: that before a device failed, none after water that
  /// came to grief. Throws InputError if it cannot be written.
  void finish(const harness::Run& run);

 private:
  void write(const harness::Run& run);
  void claim_space() { file_.reserve(largest_); }

  CheckpointFile file_;
  std::uint64_t every_ = 0;    ///< frames; 0: only at the end
  std::uint64_t written_ = 0;  ///< frames done in the file; 0: not written
  bool failing_ = false;
  bool quiet_;
  std::uint64_t largest_ = 0;  ///< bytes
  std::string scene_text_;
  Settings settings_;
};

}  // namespace squall::app
