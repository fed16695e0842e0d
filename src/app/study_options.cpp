#include "app/study_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/checks.h"
#include "app/exit_codes.h"
#include "harness/study/observables.h"
#include "harness/study/points.h"

namespace squall::app {

namespace {

void check_axis(const std::string& text) {
  std::string names;
  for (const auto axis : harness::study_axes()) {
    if (text == harness::to_string(axis)) return;
    names += std::string(names.empty() ? "" : ", ") + harness::to_string(axis);
  }
  throw UsageError(fmt::format("--vary '{}' is unknown; there are {}", text, names));
}

}  // namespace

void add_study_options(CLI::App& command, RawStudyOptions& raw) {
  command
      .add_option("--vary", raw.vary, "Only these: step, tolerance, ratio, spacing, precision, backend (all of them)")
      ->envname("SQUALL_VARY")
      ->check(not_empty())
      ->delimiter(',')
      ->allow_extra_args(false)
      ->take_all()
      ->type_name("NAME[,NAME]");
  command.add_option("--effort", raw.effort, "quick or full: how many settings, perturbed starts and timings (quick)")
      ->envname("SQUALL_EFFORT")
      ->check(not_empty())
      ->type_name("NAME");
  command
      .add_option("--error", raw.error,
                  fmt::format("Rank settings by this error: {} ({})", fmt::join(harness::error_names(), ", "),
                              harness::k_combined_error))
      ->envname("SQUALL_ERROR")
      ->check(not_empty())
      ->type_name("NAME");
  command.add_option("--max-error", raw.max_error, "Recommend the cheapest setting whose error is at most this")
      ->envname("SQUALL_MAX_ERROR")
      ->check(not_empty())
      ->check(positive())
      ->type_name("F");
  command.add_option("--perturbed", raw.perturbed, "Perturbed starts of each model, for the noise floor (3; full: 5)")
      ->envname("SQUALL_PERTURBED")
      ->check(not_empty())
      ->check(CLI::Range(0, 100))
      ->type_name("N");
  command.add_option("--repeats", raw.repeats, "Times that every setting is timed (3; full: 5)")
      ->envname("SQUALL_REPEATS")
      ->check(not_empty())
      ->check(CLI::Range(1, 100))
      ->type_name("N");
}

StudyOptions understand(const RawStudyOptions& raw) {
  StudyOptions options;
  for (const auto& text : raw.vary) check_axis(text);
  options.vary = raw.vary;
  if (raw.effort != "quick" && raw.effort != "full")
    throw UsageError(fmt::format("--effort '{}' is unknown; there are quick, full", raw.effort));
  options.full = raw.effort == "full";
  const auto names = harness::error_names();
  if (!raw.error.empty() && std::find(names.begin(), names.end(), raw.error) == names.end())
    throw UsageError(fmt::format("--error '{}' is unknown; there are {}", raw.error, fmt::join(names, ", ")));
  options.error = raw.error;
  options.max_error = raw.max_error;
  options.perturbed = raw.perturbed;
  options.repeats = raw.repeats;
  return options;
}

}  // namespace squall::app
