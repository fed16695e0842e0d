#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/earlier_results.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/notes.h"
#include "app/plans.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/sweep_folder.h"
#include "app/sweep_text.h"
#include "app/targets.h"
#include "core/errors.h"
#include "harness/report/gnuplot.h"
#include "harness/sweep_analysis.h"
#include "harness/water_warnings.h"

namespace squall::app {

namespace {

harness::SweepPlan make_plan(const Options& options, const Workload& workload, Plans& plans) {
  harness::SweepPlan plan;
  plan.runs = std::move(plans.plans);
  plan.budget_ms = options.budget_ms;
  plan.sizes = options.sizes;
  if (!plan.sizes.empty()) return plan;
  constexpr std::int64_t k_most_particles = 4'000'000;
  plan.sizes = harness::size_ladder(workload.info.particles, k_most_particles);
  plan.limit_s = 110.0;  // with the checks of a budget and the drawing, two minutes
  return plan;
}

std::vector<harness::Row> rows_of(const harness::Sweep& sweep) {
  std::vector<harness::Row> rows;
  for (const auto& point : sweep.points) rows.push_back(point.row);
  for (const auto& entry : sweep.budget)
    for (const auto& point : entry.tried) rows.push_back(point.row);
  return rows;
}

bool keeps_budget_somewhere(const harness::Sweep& sweep) {
  return std::any_of(sweep.budget.begin(), sweep.budget.end(), [](const auto& entry) { return entry.largest; });
}

int exit_code(const Options& options, const harness::Sweep& sweep, const std::vector<harness::Row>& rows,
              const Interrupt& interrupt) {
  if (sweep.interrupted) return interrupt.exit_code();
  Options without_budget = options;  // a sweep holds its medians against it, not every row
  without_budget.budget_ms.reset();
  const int code = exit_code_of(without_budget, rows, harness::overall_agreement(sweep));
  if (code != k_exit_fine) return code;
  // Where nobody named the sizes, a size that is too large is the end of the range.
  if (sweep.problem != harness::SizeProblem::none && !options.sizes.empty())
    return sweep.problem == harness::SizeProblem::memory ? k_exit_device : k_exit_input;
  return options.budget_ms && !keeps_budget_somewhere(sweep) ? k_exit_budget : k_exit_fine;
}

/// Of the first run of each size that has any: its runs are the same water.
std::vector<std::string> water_notes(const harness::Sweep& sweep) {
  std::vector<std::string> notes;
  for (const auto& size : sweep.sizes)
    for (const auto& point : sweep.points) {
      if (point.size.scene_hash != size.size.scene_hash) continue;
      const auto warnings = harness::water_warnings(point.row);
      for (const auto& text : warnings)
        notes.push_back(fmt::format("{} particles: {}", harness::count_text(size.particles), text));
      if (!warnings.empty()) break;
    }
  return notes;
}

harness::SceneAt scene_source(const Workload& workload) {
  return [&workload](std::int64_t particles) {
    const Workload sized = scaled(workload, particles);
    harness::SizedScene result;
    result.info = {sized.info.particles, sized.scene.fluid.spacing_m, sized.info.hash};
    result.make = [scene = sized.scene](const harness::RunPlan& plan) {
      return make_solver(plan.backend, scene, plan.settings);
    };
    return result;
  };
}

std::vector<std::string> rain_note(const Scene& scene) {
  if (scene.rains.empty()) return {};
  return {
      "rain falls while it is measured: particle counts are those at the end of the measured frames; --frames N "
      "measures more "
      "of it"};
}

/// Finds what cannot be scaled before anything is measured or written.
void check_sizes(const harness::SceneAt& scene_at, const Options& options, const Workload& workload) {
  for (const auto size : options.sizes) scene_at(size);
  if (options.sizes.empty()) scene_at(std::max<std::int64_t>(1, workload.info.particles));
}

harness::Sweep measure(const harness::SceneAt& scene_at, const harness::SweepPlan& plan, Progress&& progress,
                       const Interrupt& interrupt, std::optional<SweepFolder>& folder) {
  const auto after_round = [&](const harness::SweepProgress& done) {
    progress.update(done.share, done.what, done.left_s);
    return !interrupt.requested();
  };
  const auto after_size = [&](const std::vector<harness::SweepPoint>& points) {
    if (folder) folder->add_points(points);
  };
  return harness::sweep(scene_at, plan, after_round, after_size);
}

}  // namespace

int command_sweep(const Options& options) {
  const Workload workload = load_workload(options);
  const auto backends = list_backends();
  Plans plans = plan_sweep(options, workload, backends);
  const auto ratio = ratio_notes(workload.scene);
  plans.left_out.insert(plans.left_out.end(), ratio.begin(), ratio.end());
  print_notes(plans.left_out, options.quiet);
  if (plans.plans.empty()) throw DeviceError("no backend or device to sweep can run; see squall devices");

  harness::SweepResult result;
  result.scene = workload.info;
  result.frame_rate_hz = workload.scene.time.frame_rate_hz;
  result.plan = make_plan(options, workload, plans);
  const auto rain = rain_note(workload.scene);
  const auto scene_at = scene_source(workload);
  check_sizes(scene_at, options, workload);
  const Interrupt interrupt;
  std::optional<SweepFolder> folder;
  protect_inputs(options, workload,
                 options.out.empty() ? std::vector<std::filesystem::path>{} : SweepFolder::own_files(options.out));
  if (!options.out.empty()) {
    harness::require_gnuplot();
    refuse_other_results(options.out, "sweep", {subject_of(workload.info)});
    harness::SweepResult begun = result;
    begun.sweep.interrupted = true;
    folder.emplace(options.out, harness::json_text(harness::to_json(begun)));
  }
  check_targets(options);
  result.sweep = measure(scene_at, result.plan, Progress(options.quiet, workload.info.name), interrupt, folder);
  auto& notes = result.sweep.notes;
  notes.insert(notes.end(), rain.begin(), rain.end());
  const auto convergence = water_notes(result.sweep);
  notes.insert(notes.end(), convergence.begin(), convergence.end());
  print_notes(notes, options.quiet);
  notes.insert(notes.end(), plans.left_out.begin(), plans.left_out.end());
  const auto rows = rows_of(result.sweep);
  result.context = context_of(backends, rows);
  if (!options.json_alone()) std::cout << sweep_text(result) << std::flush;
  write_json(options, harness::to_json(result));
  if (folder) folder->finish(result);
  return exit_code(options, result.sweep, rows, interrupt);
}

}  // namespace squall::app
