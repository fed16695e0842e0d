#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/notes.h"
#include "app/plans.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/stress_text.h"
#include "app/targets.h"
#include "core/errors.h"
#include "harness/stress/stress_results.h"

namespace squall::app {

namespace {

std::vector<harness::StressSubject> subjects_of(const Plans& plans) {
  std::vector<harness::StressSubject> subjects;
  for (const auto& plan : plans.plans)
    subjects.push_back(
        {fmt::format("{}, {}", plan.label, to_string(plan.settings.pressure)), plan.backend, plan.settings});
  return subjects;
}

std::vector<const harness::StressCase*> cases_of(const Options& options) {
  std::vector<const harness::StressCase*> cases;
  for (const auto& tried : harness::stress_cases()) {
    const bool named = std::count(options.case_numbers.begin(), options.case_numbers.end(), tried.number) > 0;
    if (named || (options.case_numbers.empty() && (tried.quick || !options.quick))) cases.push_back(&tried);
  }
  return cases;
}

/// Tries every case on every subject; those of a device that fails end there.
std::vector<harness::StressResult> try_all(const std::vector<const harness::StressCase*>& cases,
                                           const std::vector<harness::StressSubject>& subjects, bool quick,
                                           Progress&& progress, const Interrupt& interrupt) {
  std::vector<harness::StressResult> results;
  const int total = static_cast<int>(cases.size() * subjects.size());
  for (const auto* tried : cases)
    for (const auto& subject : subjects) {
      if (interrupt.requested()) return results;
      results.push_back(harness::try_case(*tried, subject, make_solver, quick));
      progress.update(static_cast<int>(results.size()), total);
    }
  return results;
}

int exit_code(const std::vector<harness::StressResult>& results, const Interrupt& interrupt) {
  if (interrupt.requested()) return interrupt.exit_code();
  const bool unexpected = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.unexpected(); });
  return unexpected ? k_exit_unstable : k_exit_fine;
}

}  // namespace

int command_stress(const Options& options) {
  if (options.largest_step) return command_largest_step(options);
  const auto backends = list_backends();
  const Plans plans = plan_stress(options, backends);
  print_notes(plans.left_out, options.quiet);
  if (plans.plans.empty()) throw DeviceError("no backend or device to try can run; see squall devices");
  const Interrupt interrupt;
  check_targets(options);
  const auto subjects = subjects_of(plans);
  const auto results =
      try_all(cases_of(options), subjects, options.quick, Progress(options.quiet, "stress"), interrupt);
  if (!options.json_alone()) std::cout << stress_text(subjects, results) << std::flush;
  write_json(options, harness::to_json(context_of(backends, {}), options.quick, results));
  return exit_code(results, interrupt);
}

}  // namespace squall::app
