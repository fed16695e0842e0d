#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <vector>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/largest_step_text.h"
#include "app/notes.h"
#include "app/plans.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/targets.h"
#include "core/errors.h"
#include "harness/stress/largest_step_results.h"

namespace squall::app {

namespace {

using harness::StepResult;
using harness::StepSetting;

/// In each precision that is asked for; omp with one thread, since the water is little and its bits the same.
Plans plans_of(Options options, const std::vector<BackendInfo>& backends) {
  if (options.backends.empty() && options.device.empty()) options.backends = {"omp"};
  if (options.threads.empty()) options.threads = {1};
  const auto asked = options.precision;
  Plans plans;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    if (asked && *asked != precision) continue;
    options.precision = precision;
    const Plans found = plan_stress(options, backends);
    plans.plans.insert(plans.plans.end(), found.plans.begin(), found.plans.end());
    plans.left_out.insert(plans.left_out.end(), found.left_out.begin(), found.left_out.end());
  }
  return plans;
}

std::vector<StepSetting> settings_of(const Plans& plans, bool quick) {
  std::vector<harness::StressSubject> subjects;
  for (const auto& plan : plans.plans)
    subjects.push_back(
        {fmt::format("{}, {}", plan.label, to_string(plan.settings.pressure)), plan.backend, plan.settings});
  return harness::step_settings(subjects, quick);
}

/// Those that were found before somebody interrupted.
std::vector<StepResult> search_all(const std::vector<StepSetting>& settings, bool quick, Progress&& progress,
                                   const Interrupt& interrupt) {
  std::vector<StepResult> results;
  const auto start = std::chrono::steady_clock::now();
  const auto total = static_cast<double>(settings.size());
  for (const StepSetting& setting : settings) {
    const auto go_on = [&](double share) {
      const double done = (static_cast<double>(results.size()) + share) / total;
      const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      progress.update(done, setting.subject.label, done > 0.0 ? spent_s * (1.0 - done) / done : 0.0);
      return !interrupt.requested();
    };
    const auto result = harness::find_largest_step(setting, make_solver, quick, go_on);
    if (!result) break;
    results.push_back(*result);
  }
  return results;
}

}  // namespace

int command_largest_step(const Options& options) {
  const auto backends = list_backends();
  const Plans plans = plans_of(options, backends);
  print_notes(plans.left_out, options.quiet);
  if (plans.plans.empty()) throw DeviceError("no backend or device to try can run; see squall devices");
  const Interrupt interrupt;
  check_targets(options);
  const auto settings = settings_of(plans, options.quick);
  const auto results = search_all(settings, options.quick, Progress(options.quiet, "largest step"), interrupt);
  const bool interrupted = results.size() < settings.size();
  if (!options.json_alone()) std::cout << largest_step_text(results) << std::flush;
  write_json(options, harness::to_json(context_of(backends, {}), options.quick, interrupted, results));
  if (interrupted) return interrupt.exit_code();
  const bool defect =
      std::any_of(results.begin(), results.end(), [](const auto& result) { return result.is_defect(); });
  return defect ? k_exit_unstable : k_exit_fine;
}

}  // namespace squall::app
