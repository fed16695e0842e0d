#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>

#include "app/agree_plans.h"
#include "app/agree_text.h"
#include "app/commands.h"
#include "app/device_choice.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/notes.h"
#include "app/plans.h"
#include "app/progress.h"
#include "app/result_output.h"
#include "app/targets.h"
#include "core/errors.h"
#include "harness/agree/agree_results.h"

namespace squall::app {

namespace {

/// Bits need few particles to differ, and the judge is slow: a scene that is larger is scaled, unless the size is asked
/// for. One that cannot be scaled stays as it is.
Workload sized_workload(const Options& options, std::vector<std::string>& notes) {
  constexpr std::int64_t k_enough = 1000;
  Workload workload = load_workload(options);
  if (options.particles || workload.info.particles <= k_enough) return workload;
  try {
    Workload smaller = scaled(workload, k_enough);
    notes.push_back(fmt::format("{} particles instead of {}: enough to differ; --particles N takes others",
                                smaller.info.particles, workload.info.particles));
    return smaller;
  } catch (const InputError&) {
    return workload;
  }
}

harness::AgreeSettings settings_of(const Options& options, const Scene& scene) {
  harness::AgreeSettings settings;
  if (options.frames || options.seconds) settings.frames = frames_of(options, scene);
  return settings;
}

harness::Context context_for(const harness::AgreeResult& result, const std::vector<BackendInfo>& backends) {
  harness::Context context = harness::collect_context();
  for (const auto& subject : result.subjects)
    if (subject.subject.plan.backend == "opencl" && !context.opencl) {
      context.opencl = device_of(subject.subject.plan, backends);
      context.opencl_build_options = subject.solver.build_options;
    }
  return context;
}

int exit_code(const harness::AgreeResult& result, const Interrupt& interrupt) {
  if (result.interrupted) return interrupt.exit_code();
  if (result.device_failed()) return k_exit_device;
  if (!result.agree()) return k_exit_disagree;
  const bool broken = std::any_of(result.subjects.begin(), result.subjects.end(),
                                  [](const auto& subject) { return !subject.error.empty(); });
  return broken ? k_exit_unstable : k_exit_fine;
}

}  // namespace

int command_agree(const Options& options) {
  std::vector<std::string> notes;
  const Workload workload = sized_workload(options, notes);
  const auto backends = list_backends();
  const AgreePlans plans = plan_agreement(options, workload, backends);
  notes.insert(notes.end(), plans.left_out.begin(), plans.left_out.end());
  print_notes(notes, options.quiet);
  if (plans.subjects.size() < 2)
    throw DeviceError("nothing to hold against the reference: no backend or device can run; see squall devices");

  const Interrupt interrupt;
  protect_inputs(options, workload, {});
  check_targets(options);
  const auto make = [&](const harness::RunPlan& plan) {
    return make_solver(plan.backend, workload.scene, plan.settings);
  };
  harness::AgreeResult result;
  {
    Progress progress(options.quiet, workload.info.name);
    const auto start = std::chrono::steady_clock::now();
    result = harness::agree(make, plans.subjects, settings_of(options, workload.scene),
                            [&](double share, const std::string& doing) {
                              const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
                              progress.update(share, doing, spent.count() * (1.0 / share - 1.0));
                              return !interrupt.requested();
                            });
  }
  const harness::Context context = context_for(result, backends);
  if (!options.json_alone()) std::cout << agree_text(workload, context, backends, result) << std::flush;
  write_json(options, harness::to_json(context, workload.info, result));
  return exit_code(result, interrupt);
}

}  // namespace squall::app
