#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/attempts.h"
#include "app/checkpoints.h"
#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/notes.h"
#include "app/output_folder.h"
#include "app/plans.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/row_text.h"
#include "app/targets.h"
#include "app/trace_output.h"
#include "app/tuned_plans.h"
#include "harness/run.h"

namespace squall::app {

namespace {

std::string run_result_text(const Options& options, const Workload& workload, const harness::Row& row) {
  std::string text = headline(workload) + "\n" + run_text(row);
  if (row.start_frame > 0) text += fmt::format("went on from frame {}\n", row.start_frame);
  if (options.budget_ms)
    text += keeps_budget(row, *options.budget_ms) ? "budget kept at the 95th percentile\n"
                                                  : "budget exceeded at the 95th percentile\n";
  return text;
}

/// What a run leaves behind, while it goes and in the end.
class Outputs {
 public:
  Outputs(const Options& options, const Workload& workload, const harness::RunPlan& plan, std::uint64_t earlier_frames)
      : options_(options), workload_(workload) {
    if (!options.out.empty()) folder_.emplace(options.out, workload, earlier_frames);
    check_targets(options);
    if (!options.checkpoint.empty()) checkpoints_.emplace(options, workload, plan);
  }

  /// False if something could not be written that cannot be written later.
  bool after_frame(const harness::Run& run) {
    if (run.plan().settings.trace && run.frames().size() > traced_.size()) traced_.push_back(run.frames().back());
    attempts_([&] {
      if (folder_) folder_->after_frame(run, options_.save_every);
    });
    if (folder_ && checkpoints_ && checkpoints_->is_due(run)) folder_->flush();  // a checkpoint promises its rows
    if (checkpoints_) checkpoints_->after_frame(run);
    return !attempts_.failed();
  }

  void finish(const harness::Run& run, const harness::Row& row, const std::vector<BackendInfo>& backends) {
    if (folder_) folder_->flush();
    attempts_([&] {
      if (checkpoints_) checkpoints_->finish(run);
    });
    if (!options_.json_alone()) std::cout << run_result_text(options_, workload_, row) << std::flush;
    if (options_.json_alone()) print_notes(water_notes({row}), options_.quiet);
    attempts_([&] { write_result(options_, workload_, backends, {row}, std::nullopt); });
    attempts_([&] {
      if (folder_) folder_->finish();
    });
    attempts_([&] { print_notes(write_trace(options_, {{row.plan.label, &traced_}}), options_.quiet); });
    attempts_.finish();
  }

 private:
  const Options& options_;
  const Workload& workload_;
  std::optional<OutputFolder> folder_;
  std::optional<Checkpoints> checkpoints_;
  std::vector<harness::FrameRecord> traced_;
  Attempts attempts_;
};

}  // namespace

int command_run(const Options& options) {
  const Workload workload = load_workload(options);
  if (options.print_scene) {
    std::cout << print_workload(workload);
    return k_exit_fine;
  }
  const auto backends = list_backends();
  std::vector<harness::RunPlan> plans{plan_run(options, workload, backends)};
  harness::RunPlan& plan = plans.front();
  print_notes(scene_notes(workload.scene), options.quiet);

  const Interrupt interrupt;
  protect_inputs(options, workload);
  const auto restart = take_restart(options, workload, plan);
  Outputs outputs(options, workload, plan, restart ? restart->state.clock.frame : 0);
  const harness::SolverFactory make = [&](const harness::RunPlan& what) {
    return make_solver(what.backend, workload.scene, what.settings);
  };
  const auto go_on = [&] { return !interrupt.requested(); };
  print_notes(apply_tuning(options, workload, backends, make, plans, go_on), options.quiet);
  auto solver = make(plan);
  if (restart) solver->restore(restart->state);
  harness::Run run(std::move(solver), plan);
  harness::Row row;
  {
    Progress progress(options.quiet, workload.info.name);
    harness::Profile profile;
    row = harness::run_to_end(run, [&](const harness::Run&) {
      const bool written = outputs.after_frame(run);
      progress.update(run.steps_done(), run.steps_planned());
      if (run.done() && run.error().empty()) profile = harness::profile_run(make, plan, run.state());
      return written && !interrupt.requested();
    });
    harness::add_profile(profile, row);
  }
  outputs.finish(run, row, backends);
  return interrupt.requested() ? interrupt.exit_code() : exit_code_of(options, {row}, std::nullopt);
}

}  // namespace squall::app
