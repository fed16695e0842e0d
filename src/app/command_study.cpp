#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <utility>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/notes.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/study_folder.h"
#include "app/study_plans.h"
#include "app/study_text.h"
#include "app/targets.h"
#include "harness/report/gnuplot.h"
#include "harness/study/gaps.h"

namespace squall::app {

namespace {

harness::StudyQuestion question_of(const Options& options) {
  harness::StudyQuestion question;
  if (!options.study.error.empty()) question.error = options.study.error;
  question.max_error = options.study.max_error;
  question.budget_ms = options.budget_ms;
  return question;
}

/// The rows that context_of() asks for the device of.
std::vector<harness::Row> rows_of(const harness::StudySubjects& subjects) {
  std::vector<harness::Row> rows;
  for (const auto& plan : subjects.plans) rows.emplace_back().plan = plan;
  return rows;
}

/// How to do a run again. Without a folder the scene as it lies there lacks what the point changed of `studied`: the
/// command alone would be of another run, and says so.
harness::StudyCommand command_for(const harness::StudyRun& run, const std::string& name, const Scene& studied,
                                  const Options& options, std::optional<StudyFolder>& folder) {
  if (!folder) {
    const auto changes = harness::overrides_between(studied, run.scene);
    std::string rest = options.particles ? fmt::format(" --particles {}", *options.particles) : "";
    if (!changes.empty())
      rest += fmt::format("  # but with {}: --out DIR writes this scene, too", fmt::join(changes, ", "));
    return {command_of(run, options.scene) + rest, ""};
  }
  const std::string file = folder->write_scene(name, run.scene, run.plan.settings.pressure);
  return {command_of(run, file), file};
}

void add_commands(const Options& options, std::optional<StudyFolder>& folder, harness::StudyResult& result) {
  for (const auto& point : result.runs.points.points)
    result.point_commands.push_back(command_for(point.run, point.name, result.subjects.scene, options, folder));
  for (const auto& model : result.runs.models)
    result.reference_commands.push_back(model.reference ? command_for(*model.reference, model.reference->plan.label,
                                                                      result.subjects.scene, options, folder)
                                                        : harness::StudyCommand{});
}

void add_notes(harness::StudyResult& result) {
  auto& notes = result.notes;
  const auto& left_out = result.runs.points.notes;
  notes.insert(notes.end(), left_out.begin(), left_out.end());
  if (result.runs.reused > 0)
    notes.push_back(fmt::format("{} runs were there from an earlier start; remove runs.jsonl to time them again",
                                result.runs.reused));
  notes.insert(notes.end(), result.findings.gaps.begin(), result.findings.gaps.end());
  for (std::size_t m = 0; m < result.runs.models.size(); ++m)
    if (const auto& problem = result.runs.models[m].problem; !problem.empty())
      notes.push_back(fmt::format("no reference of {}: {}", result.runs.points.models[m].name, problem));
  if (result.subjects.double_plan.backend != "omp")
    notes.push_back("references and perturbed starts ran on the backend reference: omp has no double here");
  notes.push_back("strict maths only: this version has no fast maths to compare it with");
}

int exit_code(const harness::StudyResult& result, const Interrupt& interrupt) {
  if (result.runs.interrupted) return interrupt.exit_code();
  const auto& points = result.findings.points;
  const auto any = [&](harness::PointStatus status) {
    return std::any_of(points.begin(), points.end(), [&](const auto& point) { return point.status == status; });
  };
  if (any(harness::PointStatus::failed)) return k_exit_device;
  if (!any(harness::PointStatus::fine)) return k_exit_unstable;
  if (result.findings.front.empty()) {
    // Without a single reference the fault is the water's; with one, the scene gives nothing to judge it by.
    const bool lacks_reference = !result.findings.yardstick && !harness::is_exact(result.question.error);
    return lacks_reference ? k_exit_unstable : k_exit_input;
  }
  return result.question.budget_ms && !result.findings.best ? k_exit_budget : k_exit_fine;
}

harness::StudyRuns measure(const harness::StudyResult& result, const Options& options, const Interrupt& interrupt,
                           harness::StudyRecords& records) {
  Progress progress(options.quiet, result.scene.name);
  const auto after_frame = [&](const harness::StudyProgress& done) {
    progress.update(done.share, done.what, done.left_s);
    return !interrupt.requested();
  };
  const auto make = [](const harness::RunPlan& plan, const Scene& scene) {
    return make_solver(plan.backend, scene, plan.settings);
  };
  return harness::run_study(result.subjects, result.context, make, records, after_frame);
}

}  // namespace

int command_study(const Options& options) {
  const Workload workload = load_workload(options);
  const auto backends = list_backends();
  StudyPlan plan = plan_study(options, workload, backends);
  harness::StudyResult result;
  result.scene = workload.info;
  result.subjects = std::move(plan.subjects);
  result.question = question_of(options);
  harness::require_water(workload.scene, result.subjects.plans.front().frames);
  result.notes = std::move(plan.left_out);
  result.context = context_of(backends, rows_of(result.subjects));
  print_notes(result.notes, options.quiet);

  protect_inputs(options, workload,
                 options.out.empty() ? std::vector<std::filesystem::path>{} : StudyFolder::own_files(options.out));
  const Interrupt interrupt;
  std::optional<StudyFolder> folder;
  harness::StudyRecords records([&](const harness::Record& record) {
    if (folder) folder->keep(record);
  });
  if (!options.out.empty()) {
    harness::require_gnuplot();
    folder.emplace(options.out, result.scene);
    for (auto& record : folder->take_earlier_runs()) records.put(std::move(record));
  }
  check_targets(options);
  result.runs = measure(result, options, interrupt, records);
  result.findings = harness::find_out(result.runs, result.question);
  add_commands(options, folder, result);
  const std::size_t printed = result.notes.size();
  add_notes(result);
  print_notes({result.notes.begin() + static_cast<std::ptrdiff_t>(printed), result.notes.end()}, options.quiet);
  if (!options.json_alone()) std::cout << study_text(result) << std::flush;
  write_json(options, harness::to_json(result));
  if (folder) folder->finish(result);
  return exit_code(result, interrupt);
}

}  // namespace squall::app
