#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

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
  if (options.budget_ms)
    text += keeps_budget(row, *options.budget_ms) ? "budget kept at the 95th percentile\n"
                                                  : "budget exceeded at the 95th percentile\n";
  return text;
}

}  // namespace

int command_run(const Options& options) {
  const Workload workload = load_workload(options);
  if (options.print_scene) {
    std::cout << print_workload(workload);
    return k_exit_fine;
  }
  const auto backends = list_backends();
  std::vector<harness::RunPlan> plans{plan_run(options, workload, backends)};
  print_notes(scene_notes(workload.scene), options.quiet);

  const Interrupt interrupt;
  protect_inputs(options, workload);
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out, workload);
  check_targets(options);
  const harness::SolverFactory make = [&](const harness::RunPlan& what) {
    return make_solver(what.backend, workload.scene, what.settings);
  };
  const auto go_on = [&] { return !interrupt.requested(); };
  print_notes(apply_tuning(options, workload, backends, make, plans, go_on), options.quiet);
  const harness::RunPlan& plan = plans.front();
  harness::Row row;
  std::vector<harness::FrameRecord> traced;
  {
    Progress progress(options.quiet, workload.info.name);
    harness::Profile profile;
    row = harness::run_once(make(plan), plan, [&](const harness::Run& run) {
      if (plan.settings.trace && run.frames().size() > traced.size()) traced.push_back(run.frames().back());
      if (folder) folder->after_frame(run, options.save_every);
      progress.update(run.steps_done(), run.steps_planned());
      if (run.done() && run.error().empty()) profile = harness::profile_run(make, plan, run.state());
      return !interrupt.requested();
    });
    harness::add_profile(profile, row);
  }
  if (!options.json_alone()) std::cout << run_result_text(options, workload, row) << std::flush;
  write_result(options, workload, backends, {row}, std::nullopt);
  if (folder) folder->finish();
  print_notes(write_trace(options, {{plan.label, &traced}}), options.quiet);
  return interrupt.requested() ? k_exit_interrupted : exit_code_of(options, {row}, std::nullopt);
}

}  // namespace squall::app
