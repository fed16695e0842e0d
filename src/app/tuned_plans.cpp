#include "app/tuned_plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/device_choice.h"
#include "app/notes.h"
#include "app/plans.h"
#include "app/tuning_table.h"
#include "core/errors.h"
#include "harness/tuning.h"

namespace squall::app {

namespace {

constexpr std::chrono::seconds k_time_limit{30};

std::string trials_text(const harness::Tuning& tuning) {
  const auto fastest = std::min_element(tuning.trials.begin(), tuning.trials.end(), [](const auto& a, const auto& b) {
    return a.ms_per_substep < b.ms_per_substep;
  });
  return fmt::format("{} tried{}, {:.3f} ms per sub-step as the device suggests, {:.3f} at best", tuning.trials.size(),
                     tuning.complete ? "" : " before the time limit", tuning.trials.front().ms_per_substep,
                     fastest->ms_per_substep);
}

/// Measures and remembers; says so. A device that fails is left to the run, which will say why.
harness::WorkChoice measure(const harness::SolverFactory& make, const harness::RunPlan& plan, const DeviceInfo& device,
                            const TuningTable* table, const std::string& key, const harness::GoOn& go_on,
                            std::vector<std::string>& notes) {
  const harness::WorkChoice untuned{plan.settings.simd, plan.settings.work};
  harness::Tuning tuning;
  try {
    tuning = harness::tune(make, plan, device, k_time_limit, go_on);
  } catch (const DeviceError& error) {
    notes.push_back(fmt::format("{} not tuned: {}", plan.label, error.what()));
    return untuned;
  }
  if (!go_on()) return untuned;
  notes.push_back(fmt::format("{} tuned: {}; {}", plan.label, to_string(tuning.best), trials_text(tuning)));
  if (table == nullptr) return tuning.best;
  try {
    table->store(key, tuning.best);
  } catch (const InputError& error) {
    notes.push_back(error.what());
  }
  return tuning.best;
}

}  // namespace

std::vector<std::string> apply_tuning(const Options& options, const Workload& workload,
                                      const std::vector<BackendInfo>& backends, const harness::SolverFactory& make,
                                      std::vector<harness::RunPlan>& plans, const harness::GoOn& go_on) {
  const bool no_table = options.tuning == "none";
  const TuningTable table(options.tuning.empty() ? TuningTable::default_path() : options.tuning);
  const bool has_table = !no_table && !table.path().empty();
  std::vector<std::string> notes;
  std::map<std::string, harness::WorkChoice> known;  // plans that differ in read-back alone share one choice
  for (harness::RunPlan& plan : plans) {
    if (plan.backend != "opencl") continue;
    const DeviceInfo& device = device_of(plan, backends);
    const auto particles = static_cast<std::size_t>(workload.info.particles);
    const std::string key = tuning_key(device, workload.scene, plan.settings, particles);
    if (!known.contains(key)) {
      if (options.tune && go_on()) {
        print_notes({fmt::format("{}: measuring work sizes, for at most {} s", plan.label, k_time_limit.count())},
                    options.quiet);
        known[key] = measure(make, plan, device, has_table ? &table : nullptr, key, go_on, notes);
      } else if (const auto found = has_table ? table.find(key) : std::nullopt) {
        known[key] = *found;
        notes.push_back(
            fmt::format("{} with tuned work sizes: {}; --tuning none goes without", plan.label, to_string(*found)));
      } else {
        known[key] = {plan.settings.simd, plan.settings.work};
        if (has_table && !options.tuning.empty() && !options.tune)
          notes.push_back(fmt::format(
              "{} runs with sizes by the device: {} {}; --tune measures", plan.label, table.path(),
              table.is_there() ? "has no work sizes for it and a scene of this kind and size" : "is no tuning table"));
      }
    }
    plan.settings.simd = known[key].simd;
    plan.settings.work = known[key].work;
  }
  return notes;
}

}  // namespace squall::app
