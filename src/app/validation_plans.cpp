#include <fmt/format.h>

#include "app/device_choice.h"
#include "app/plans.h"
#include "core/errors.h"

namespace squall::app {

namespace {

/// Why a backend does not have a pressure solver; empty if it does. Asked by trying, so that nothing here needs to
/// know.
std::string refusal_of(const std::string& backend, const Settings& settings) {
  Scene scene;
  scene.name = "probe";
  scene.time.duration_s = 1.0;
  scene.fluid.spacing_m = 0.1;
  scene.container.max_m = {0.4, 0.4, 0.4};
  try {
    make_solver(backend, scene, settings);
  } catch (const InputError& refusal) {
    return refusal.what();
  }
  return "";
}

harness::RunPlan validation_plan(const Options& options, Pressure pressure, const BackendInfo& backend) {
  harness::RunPlan plan;
  plan.backend = backend.name;
  plan.settings.pressure = pressure;
  plan.settings.seed = options.seed;
  plan.settings.precision = precision_of(options, backend.name);
  if (backend.name != "reference" && options.simd) plan.settings.simd = *options.simd;
  if (backend.name != "reference" && !options.threads.empty()) plan.settings.threads = options.threads.front();
  if (backend.name == "opencl") {
    const DeviceInfo device = select_devices(backend, options.device).front();
    if (const auto problem = problem_in(device, plan.settings.precision); !problem.empty())
      throw DeviceError(device.name + " cannot run: " + problem);
    plan.settings.device = std::to_string(device.index);
  }
  plan.label = plan.backend;
  return plan;
}

}  // namespace

Plans plan_validation(const Options& options, Pressure pressure, const std::vector<BackendInfo>& backends) {
  Plans result;
  const bool by_name = !options.backends.empty() || !options.device.empty();
  std::vector<std::string> names = options.backends;
  if (names.empty())
    names = by_name ? std::vector<std::string>{"opencl"} : std::vector<std::string>{"omp", "opencl", "reference"};
  for (const auto& name : names) {
    const BackendInfo& backend = find_backend(backends, name);
    const std::string problem = problem_of(backend);
    if (!problem.empty() && by_name) throw DeviceError(fmt::format("backend {} cannot run: {}", name, problem));
    if (!problem.empty()) continue;
    harness::RunPlan plan = validation_plan(options, pressure, backend);
    const std::string refusal = refusal_of(name, plan.settings);
    if (!refusal.empty()) {
      if (by_name)
        result.left_out.push_back(fmt::format("{} on {} is left out: {}", to_string(pressure), name, refusal));
      continue;
    }
    result.plans.push_back(std::move(plan));
    if (!by_name) return result;
  }
  return result;
}

}  // namespace squall::app
