#include "app/plans.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/device_choice.h"
#include "app/exit_codes.h"
#include "core/errors.h"

namespace squall::app {

namespace {

using harness::RunPlan;

RunPlan base_plan(const Options& options, const Workload& workload, const std::string& backend) {
  RunPlan plan;
  plan.backend = backend;
  plan.settings.pressure = workload.pressure;
  plan.settings.seed = options.seed;
  plan.settings.trace = !options.trace.empty();
  plan.settings.precision = precision_of(options, backend);
  if (backend != "reference" && options.simd) plan.settings.simd = *options.simd;
  return plan;
}

std::string threads_text(int threads) {
  return threads == 0 ? "" : fmt::format(", {} thread{}", threads, threads == 1 ? "" : "s");
}

void name_plan(RunPlan& plan) {
  const Settings& settings = plan.settings;
  plan.label = plan.backend;
  const bool single = settings.precision == Precision::single_precision;
  if (plan.backend == "reference") plan.label += single ? ", single" : ", double";
  if (plan.backend == "opencl") plan.label += fmt::format(" {}, {}", settings.device, to_string(settings.readback));
  plan.label += threads_text(settings.threads);
  if (plan.backend != "reference" && !single) plan.label += ", double";
}

std::string default_backend(const Options& options, const std::vector<BackendInfo>& backends) {
  if (!options.backends.empty()) return options.backends.front();
  if (!options.device.empty()) return "opencl";
  if (!problem_of(find_backend(backends, "omp")).empty())
    throw DeviceError("backend omp cannot run: " + problem_of(find_backend(backends, "omp")) +
                      "; name another by --backend");
  return "omp";
}

/// Thread counts to measure omp with: as asked, else 1 and all; a sweep also takes the powers of two between.
std::vector<int> omp_threads(const Options& options, const BackendInfo& omp) {
  if (!options.threads.empty()) return options.threads;
  const int all = omp.devices.empty() ? 1 : omp.devices.front().compute_units;
  std::vector<int> counts{1};
  if (options.command == Command::sweep)
    for (int count = 2; count < all; count *= 2) counts.push_back(count);
  if (all > 1) counts.push_back(all);
  return counts;
}

/// Read-back modes to measure a device with: as asked, else all; a sweep takes the one that should suit it best.
std::vector<Readback> readbacks_for(const Options& options, const DeviceInfo& device) {
  static constexpr Readback k_all[] = {Readback::none,   Readback::blocking, Readback::pinned,
                                       Readback::mapped, Readback::async,    Readback::quantized};
  // Mapping copies nothing where host and device share memory; elsewhere pinned copies half as much.
  if (options.readbacks.empty() && options.command == Command::sweep)
    return {device.kind == "cpu" ? Readback::mapped : Readback::pinned};
  std::vector<Readback> modes;
  for (const Readback mode : k_all)
    if (options.readbacks.empty() || std::count(options.readbacks.begin(), options.readbacks.end(), mode) > 0)
      modes.push_back(mode);
  return modes;
}

class ComparisonPlanner {
 public:
  ComparisonPlanner(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends)
      : options_(options), workload_(workload), backends_(backends) {}

  Plans plan() {
    if (asked("reference")) add(base_plan(options_, workload_, "reference"), true);
    if (wanted("omp")) add_omp();
    if (wanted("opencl")) add_opencl();
    return std::move(result_);
  }

 private:
  bool asked(const std::string& backend) const {
    return std::count(options_.backends.begin(), options_.backends.end(), backend) > 0;
  }
  bool wanted(const std::string& backend) {
    if (!options_.backends.empty() && !asked(backend)) return false;
    const bool by_name = asked(backend) || (backend == "opencl" && !options_.device.empty());
    const std::string problem = problem_of(find_backend(backends_, backend));
    if (problem.empty()) return true;
    if (by_name) throw DeviceError("backend " + backend + " cannot run: " + problem);
    result_.left_out.push_back(backend + " is left out: " + problem);
    return false;
  }
  void add(RunPlan plan, bool strict) {
    plan.strict = strict;
    if (options_.frames || options_.seconds) plan.frames = frames_of(options_, workload_.scene);
    name_plan(plan);
    result_.plans.push_back(std::move(plan));
  }
  void add_omp() {
    const BackendInfo& omp = find_backend(backends_, "omp");
    for (const int threads : omp_threads(options_, omp)) {
      RunPlan plan = base_plan(options_, workload_, "omp");
      plan.settings.threads = threads;
      const bool strict = omp.devices.empty() || promises_bits(omp.devices.front(), plan.settings.precision);
      add(std::move(plan), strict);
    }
  }
  void add_opencl() {
    for (const DeviceInfo& device : select_devices(find_backend(backends_, "opencl"), options_.device)) {
      const std::string problem = problem_in(device, precision_of(options_, "opencl"));
      if (!problem.empty()) {
        if (!options_.device.empty()) throw DeviceError(device.name + " cannot run: " + problem);
        result_.left_out.push_back(device.name + " is left out: " + problem);
        continue;
      }
      // A GPU has no threads to choose.
      const bool splits = device.kind == "cpu" && !options_.threads.empty();
      for (const int threads : splits ? options_.threads : std::vector<int>{0}) add_device(device, threads);
    }
  }
  void add_device(const DeviceInfo& device, int threads) {
    for (const Readback mode : readbacks_for(options_, device)) {
      RunPlan plan = base_plan(options_, workload_, "opencl");
      plan.settings.device = std::to_string(device.index);
      plan.settings.threads = threads;
      plan.settings.readback = mode;
      const bool strict = promises_bits(device, plan.settings.precision);
      add(std::move(plan), strict);
    }
  }

  const Options& options_;
  const Workload& workload_;
  const std::vector<BackendInfo>& backends_;
  Plans result_;
};

}  // namespace

RunPlan plan_run(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends) {
  const std::string name = default_backend(options, backends);
  const BackendInfo& backend = find_backend(backends, name);
  if (const auto problem = problem_of(backend); !problem.empty())
    throw DeviceError("backend " + name + " cannot run: " + problem);
  const DeviceInfo device = select_devices(backend, options.device).front();
  RunPlan plan = base_plan(options, workload, name);
  const Precision precision = plan.settings.precision;
  if (const auto problem = problem_in(device, precision); !problem.empty())
    throw DeviceError(device.name + " cannot run: " + problem);
  plan.strict = promises_bits(device, precision);
  if (name == "opencl") plan.settings.device = std::to_string(device.index);
  if (!options.threads.empty()) plan.settings.threads = options.threads.front();
  if (!options.readbacks.empty()) plan.settings.readback = options.readbacks.front();
  plan.frames = frames_of(options, workload.scene);
  // First launches cost up to a second on some devices; the reference has nothing to warm up.
  plan.warm_up_frames = name == "reference" ? 0 : 2;
  plan.rewind = true;
  name_plan(plan);
  return plan;
}

Plans plan_comparison(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends) {
  return ComparisonPlanner(options, workload, backends).plan();
}

Plans plan_sweep(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends) {
  Plans plans = plan_comparison(options, workload, backends);
  constexpr int k_frames = 30;  // several sizes have to share the user's patience
  if (!options.frames && !options.seconds)
    for (auto& plan : plans.plans) plan.frames = k_frames;
  return plans;
}

Plans plan_stress(const Options& options, const std::vector<BackendInfo>& backends) {
  Options one_each = options;
  one_each.readbacks = {Readback::mapped};
  const auto& omp = find_backend(backends, "omp").devices;
  if (one_each.threads.empty() && !omp.empty()) one_each.threads = {omp.front().compute_units};
  Plans plans;
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph}) {
    const bool named = std::count(options.pressures.begin(), options.pressures.end(), pressure) > 0;
    if (!options.pressures.empty() && !named) continue;
    Workload workload;
    workload.pressure = pressure;
    try {
      Plans found = plan_comparison(one_each, workload, backends);
      plans.plans.insert(plans.plans.end(), found.plans.begin(), found.plans.end());
      plans.left_out.insert(plans.left_out.end(), found.left_out.begin(), found.left_out.end());
    } catch (const UsageError& refusal) {
      if (named) throw;
      plans.left_out.push_back(refusal.what());
    }
  }
  return plans;
}

}  // namespace squall::app
