#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/comparison_text.h"
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
#include "core/errors.h"
#include "harness/compare.h"

namespace squall::app {

namespace {

void write_frames(const harness::Comparison& comparison, OutputFolder& folder) {
  for (std::size_t i = 0; i < comparison.rows.size(); ++i)
    for (const auto& frame : comparison.frames[i]) folder.add_frame(comparison.rows[i].plan.label, frame);
  folder.finish();
}

std::vector<harness::TracedRun> traced_runs(const harness::Comparison& comparison) {
  std::vector<harness::TracedRun> runs;
  for (std::size_t i = 0; i < comparison.rows.size(); ++i)
    runs.push_back({comparison.rows[i].plan.label, &comparison.frames[i]});
  return runs;
}

/// A comparison whose length nobody asked for does not take longer than two minutes, set-up and profiling included.
class TimeLimit {
 public:
  explicit TimeLimit(const Options& options) : limited_(!options.frames && !options.seconds) {}
  bool reached(int rounds_done, int warm_up_frames) const {
    constexpr std::chrono::seconds k_limit{90};
    constexpr int k_least_frames = 10;  // fewer have no tails
    return limited_ && rounds_done >= warm_up_frames + k_least_frames && Clock::now() - start_ > k_limit;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool limited_;
  Clock::time_point start_ = Clock::now();
};

std::vector<std::string> notes_on_length(const Options& options, const Plans& plans,
                                         const harness::Comparison& comparison, bool interrupted) {
  const int planned = plans.plans.front().frames;
  int frames = 0;
  for (const auto& row : comparison.rows) frames = std::max(frames, row.frames);
  if (interrupted || options.frames || options.seconds || frames >= planned) return {};
  const bool all_failed =
      std::none_of(comparison.rows.begin(), comparison.rows.end(), [](const auto& row) { return row.error.empty(); });
  if (all_failed) return {};
  return {fmt::format("stopped by the time limit after {} of {} frames; --frames N takes as long as it takes", frames,
                      planned)};
}

}  // namespace

int command_compare(const Options& options) {
  const Workload workload = load_workload(options);
  const auto backends = list_backends();
  Plans plans = plan_comparison(options, workload, backends);
  auto notes = scene_notes(workload.scene);
  notes.insert(notes.end(), plans.left_out.begin(), plans.left_out.end());
  print_notes(notes, options.quiet);
  if (plans.plans.empty()) throw DeviceError("no backend or device to compare can run; see squall devices");

  const Interrupt interrupt;
  protect_inputs(options, workload);
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out, workload);
  check_targets(options);
  const auto make = [&](const harness::RunPlan& plan) {
    return make_solver(plan.backend, workload.scene, plan.settings);
  };
  const auto go_on = [&] { return !interrupt.requested(); };
  print_notes(apply_tuning(options, workload, backends, make, plans.plans, go_on), options.quiet);
  harness::Comparison comparison;
  {
    Progress progress(options.quiet, workload.info.name);
    const TimeLimit limit(options);
    comparison = harness::compare(make, plans.plans, [&](int done, int total) {
      progress.update(done, total);
      return !interrupt.requested() && !limit.reached(done, plans.plans.front().warm_up_frames);
    });
  }
  print_notes(notes_on_length(options, plans, comparison, interrupt.requested()), options.quiet);
  if (!options.json_alone())
    std::cout << headline(workload) << "\n" << comparison_text(comparison, options.budget_ms) << std::flush;
  else
    print_notes(water_notes(comparison.rows), options.quiet);
  write_result(options, workload, backends, comparison.rows, comparison.agreement);
  if (folder) write_frames(comparison, *folder);
  print_notes(write_trace(options, traced_runs(comparison)), options.quiet);
  return interrupt.requested() ? interrupt.exit_code() : exit_code_of(options, comparison.rows, comparison.agreement);
}

}  // namespace squall::app
