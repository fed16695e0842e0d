#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include "app/builtin_cases.h"
#include "app/commands.h"
#include "app/earlier_results.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/notes.h"
#include "app/plans.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/targets.h"
#include "app/validation_folder.h"
#include "app/validation_text.h"
#include "core/errors.h"
#include "core/nearest_name.h"
#include "core/time_step.h"
#include "harness/report/gnuplot.h"
#include "harness/validation/results.h"

namespace squall::app {

namespace {

/// A file, or else the name of a case that comes with squall.
harness::Case case_named(const Options& options, const std::string& text) {
  if (!options.expected.empty()) return harness::case_from_table(text, options.expected, *options.tolerance);
  const bool is_file = std::filesystem::exists(text) || text.ends_with(".toml") || text.find('/') != std::string::npos;
  if (is_file) return harness::load_case(text);
  const auto names = builtin_case_names();
  if (std::find(names.begin(), names.end(), text) != names.end()) return builtin_case(text);
  throw InputError(
      fmt::format("'{}' is neither a file nor a case that comes with squall; did you mean '{}'? There are {}", text,
                  nearest_name(text, names), fmt::join(names, ", ")));
}

/// One solver of a case on one backend, its scene as it will run.
struct Job {
  std::size_t result = 0;
  harness::RunPlan plan;
  Scene scene;
};

struct Jobs {
  std::vector<harness::CaseResult> results;
  std::vector<Job> jobs;
  std::vector<std::string> notes;
};

void note_once(std::vector<std::string>& notes, const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

std::optional<std::int64_t> size_of(const Options& options, const harness::Case& what, const std::string& backend) {
  // Who names no case means those that can be scaled.
  const bool fixed = options.cases.empty() && !what.scene.particle_files.empty();
  if (options.particles && !fixed) return options.particles;
  const bool small = options.quick || backend == "reference";
  return small && what.quick_particles ? what.quick_particles : what.particles;
}

Scene scene_for(const Options& options, harness::Case& what, const std::string& backend) {
  if (options.dt_max_s) what.scene.solver.dt_max_s = *options.dt_max_s;
  return harness::scene_of(what, size_of(options, what, backend));
}

void add_jobs(const Options& options, harness::Case what, const std::vector<BackendInfo>& backends, Jobs& jobs) {
  const std::size_t index = jobs.results.size();
  if (options.particles && options.cases.empty() && !what.scene.particle_files.empty())
    note_once(jobs.notes, what.name + " has its particles from a file and runs as written, whatever --particles says");
  for (const auto& note : ratio_notes(what.scene)) note_once(jobs.notes, what.name + ": " + note);
  const std::size_t jobs_before = jobs.jobs.size();
  std::string refusal;
  for (const Pressure pressure : what.solvers) {
    const auto& asked = options.pressures;
    if (!asked.empty() && std::find(asked.begin(), asked.end(), pressure) == asked.end()) continue;
    const Plans plans = plan_validation(options, pressure, backends);
    for (const auto& reason : plans.left_out) note_once(jobs.notes, reason);
    for (const auto& plan : plans.plans) {
      Scene scene = scene_for(options, what, plan.backend);
      const std::string problem = step_problem(scene, pressure);
      if (problem.empty()) {
        jobs.jobs.push_back({index, plan, std::move(scene)});
        continue;
      }
      if (!asked.empty()) throw InputError(fmt::format("{}: {}: {}", what.name, to_string(pressure), problem));
      refusal = fmt::format("{}: {} is left out: {}", what.name, to_string(pressure), problem);
      note_once(jobs.notes, refusal);
    }
  }
  if (!refusal.empty() && jobs.jobs.size() == jobs_before) throw InputError(refusal);
  jobs.results.push_back({std::move(what), {}});
}

/// Results and files are told apart by the name.
void refuse_twin(const harness::Case& what, const std::vector<harness::CaseResult>& others) {
  for (const auto& other : others)
    if (other.what.name == what.name)
      throw UsageError(
          fmt::format("two cases are called {}; rename a file, or validate them one after the other", what.name));
}

Jobs plan_jobs(const Options& options, const std::vector<BackendInfo>& backends) {
  Jobs jobs;
  const auto names = options.cases.empty() ? builtin_case_names() : options.cases;
  for (const auto& name : names) {
    harness::Case what = case_named(options, name);
    refuse_twin(what, jobs.results);
    add_jobs(options, std::move(what), backends, jobs);
  }
  if (jobs.jobs.empty())
    throw UsageError("no case runs with these solvers and backends" +
                     (jobs.notes.empty() ? std::string("; the cases have others") : ": " + jobs.notes.front()));
  return jobs;
}

/// Neither --json nor what --out writes may take the place of what a case is read from.
void protect_cases(const Options& options, const Jobs& jobs) {
  std::vector<std::string> inputs;
  for (const auto& result : jobs.results)
    inputs.insert(inputs.end(), result.what.files.begin(), result.what.files.end());
  std::vector<std::filesystem::path> out_files;
  if (!options.out.empty()) {
    out_files = ValidationFolder::own_files(options.out);
    for (const auto& job : jobs.jobs)
      out_files.push_back(ValidationFolder::series_file(options.out, jobs.results[job.result].what.name, job.plan));
  }
  protect_inputs(options, std::move(inputs), out_files);
}

std::vector<Subject> subjects_of(const std::vector<harness::CaseResult>& results) {
  std::vector<Subject> subjects;
  for (const auto& result : results)
    subjects.push_back(subject_of(result.what.name, result.what.scene.name, scene_hash(result.what.scene)));
  return subjects;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<harness::CaseResult> started(std::vector<harness::CaseResult> results) {
  std::erase_if(results, [](const auto& result) { return result.runs.empty(); });
  return results;
}

harness::Context context_of_runs(const std::vector<BackendInfo>& backends,
                                 const std::vector<harness::CaseResult>& results) {
  std::vector<harness::Row> rows;
  for (const auto& result : results)
    for (const auto& run : result.runs) {
      harness::Row row;
      row.plan = run.plan;
      row.solver = run.solver;
      rows.push_back(row);
    }
  return context_of(backends, rows);
}

std::vector<std::string> warnings_of(const std::vector<harness::CaseResult>& results) {
  std::vector<std::string> all;
  for (const auto& result : results)
    for (const auto& run : result.runs)
      for (const auto& warning : run.warnings)
        all.push_back(fmt::format("{}, {}: {}", result.what.name, harness::run_name(run), warning));
  return all;
}

/// Of a validation that is not over.
harness::Json json_so_far(const std::vector<BackendInfo>& backends, const Jobs& jobs) {
  const auto results = started(jobs.results);
  auto json = harness::to_json(context_of_runs(backends, results), results, jobs.notes);
  json["interrupted"] = true;
  return json;
}

/// Runs everything; false if it was interrupted.
bool run_jobs(const Options& options, const std::vector<BackendInfo>& backends, Jobs& jobs, const Interrupt& interrupt,
              std::optional<ValidationFolder>& folder) {
  Progress progress(options.quiet, "validate");
  const auto start = std::chrono::steady_clock::now();
  const auto make = [](const harness::RunPlan& plan, const Scene& scene) {
    return make_solver(plan.backend, scene, plan.settings);
  };
  for (std::size_t j = 0; j < jobs.jobs.size(); ++j) {
    const Job& job = jobs.jobs[j];
    harness::CaseResult& result = jobs.results[job.result];
    const auto after_sample = [&](double share) {
      const double done = (static_cast<double>(j) + share) / static_cast<double>(jobs.jobs.size());
      progress.update(done, result.what.name, seconds_since(start) * (1.0 - done) / done);
      return !interrupt.requested();
    };
    result.runs.push_back(harness::run_case(result.what, job.scene, job.plan, make, after_sample));
    const bool last = j + 1 == jobs.jobs.size() || jobs.jobs[j + 1].result != job.result;
    if (!last && !interrupt.requested()) continue;
    progress.clear();
    if (!options.json_alone()) std::cout << case_text(result) << std::flush;
    if (folder) folder->add(result, json_so_far(backends, jobs));
    if (interrupt.requested()) return false;
  }
  return true;
}

int exit_code(const std::vector<harness::CaseResult>& results) {
  for (const auto& result : results)
    for (const auto& run : result.runs)
      if (run.device_failed) return k_exit_device;
  return harness::all_as_expected(results) ? k_exit_fine : k_exit_disagree;
}

}  // namespace

int command_validate(const Options& options) {
  if (options.list) {
    std::cout << validation_list();
    return k_exit_fine;
  }
  const auto backends = list_backends();
  Jobs jobs = plan_jobs(options, backends);
  print_notes(jobs.notes, options.quiet);
  protect_cases(options, jobs);
  const Interrupt interrupt;
  std::optional<ValidationFolder> folder;
  if (!options.out.empty()) {
    harness::require_gnuplot();
    refuse_other_results(options.out, "validate", subjects_of(jobs.results));
    folder.emplace(options.out);
  }
  check_targets(options);
  const bool finished = run_jobs(options, backends, jobs, interrupt, folder);
  const auto results = started(std::move(jobs.results));
  const auto context = context_of_runs(backends, results);
  if (!options.json_alone()) std::cout << validation_summary(results) << std::flush;
  if (options.json_alone()) print_notes(warnings_of(results), options.quiet);
  write_json(options, harness::to_json(context, results, jobs.notes));
  if (folder) folder->finish(context, results, jobs.notes);
  return finished ? exit_code(results) : interrupt.exit_code();
}

}  // namespace squall::app
