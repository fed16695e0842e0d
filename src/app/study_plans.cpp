#include "app/study_plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "app/exit_codes.h"
#include "app/plans.h"
#include "core/errors.h"

namespace squall::app {

namespace {

using harness::RunPlan;

constexpr double k_quick_s = 0.5, k_full_s = 1.0;  ///< of water, where nobody says how much

/// Whether a backend computes in double. Asked by trying, so that nothing here needs to know.
bool has_double(const std::string& backend, RunPlan plan) {
  Scene scene;
  scene.name = "probe";
  scene.time.duration_s = 1.0;
  scene.fluid.spacing_m = 0.1;
  scene.container.max_m = {0.4, 0.4, 0.4};
  plan.settings.precision = Precision::double_precision;
  try {
    make_solver(backend, scene, plan.settings);
    return true;
  } catch (const InputError&) {
    return false;
  } catch (const DeviceError&) {
    return false;
  }
}

/// A word that a shell takes as it is.
std::string shell_word(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("/._-+,:@%", c) != nullptr; };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

class Planner {
 public:
  Planner(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends)
      : options_(options), workload_(workload), backends_(backends) {}

  StudyPlan plan() {
    auto& subjects = result_.subjects;
    subjects.scene = workload_.scene;
    subjects.pressures = options_.pressures;
    if (subjects.pressures.empty()) subjects.pressures = {Pressure::wcsph, Pressure::dfsph, Pressure::mueller};
    if (options_.pressures.empty() && workload_.scene.solver.pressure)
      subjects.pressures = {*workload_.scene.solver.pressure};
    for (const auto axis : harness::study_axes())
      if (options_.study.vary.empty() ||
          std::count(options_.study.vary.begin(), options_.study.vary.end(), harness::to_string(axis)) > 0)
        subjects.axes.push_back(axis);
    subjects.ranges = options_.study.full ? harness::full_ranges() : harness::quick_ranges();
    if (options_.study.perturbed) subjects.ranges.perturbed = *options_.study.perturbed;
    if (options_.study.repeats) subjects.ranges.repeats = *options_.study.repeats;
    add_plans();
    add_double();
    return std::move(result_);
  }

 private:
  std::vector<std::string> names() const {
    if (!options_.backends.empty()) return options_.backends;
    return options_.device.empty() ? std::vector<std::string>{"omp", "opencl"} : std::vector<std::string>{"opencl"};
  }

  RunPlan plan_of(const std::string& backend) const {
    Options one = options_;
    one.backends = {backend};
    one.precision.reset();
    if (backend != "opencl") one.device.clear();
    if (!one.frames && !one.seconds) {
      const double seconds = options_.study.full ? k_full_s : k_quick_s;
      one.seconds = std::min(seconds, workload_.scene.time.duration_s);
    }
    return plan_run(one, workload_, backends_);
  }

  void add_plans() {
    const bool by_name = !options_.backends.empty() || !options_.device.empty();
    for (const auto& name : names()) {
      try {
        result_.subjects.plans.push_back(plan_of(name));
      } catch (const DeviceError& problem) {
        if (by_name) throw;
        result_.left_out.push_back(fmt::format("{} is left out: {}", name, problem.what()));
      }
    }
    if (result_.subjects.plans.empty()) throw DeviceError("no backend to study can run; see squall devices");
  }

  static RunPlan in_double(RunPlan plan) {
    plan.settings.precision = Precision::double_precision;
    plan.label = plan.backend + ", double";
    return plan;
  }

  /// References and perturbed starts are computed by omp, if it has double, else by the reference backend; each backend
  /// that has double also stands beside itself in single.
  void add_double() {
    auto& subjects = result_.subjects;
    const auto singles = subjects.plans;
    for (const auto& plan : singles) {
      if (plan.settings.precision == Precision::double_precision) continue;
      if (has_double(plan.backend, plan))
        subjects.plans.push_back(in_double(plan));
      else if (varies(harness::StudyAxis::precision))
        result_.left_out.push_back(fmt::format("double on {} is left out: it does not have it", plan.backend));
    }
    const bool omp = can_run("omp") && has_double("omp", plan_of("omp"));
    subjects.double_plan = in_double(plan_of(omp ? "omp" : "reference"));
    subjects.double_plan.frames = subjects.plans.front().frames;
  }

  bool can_run(const std::string& backend) const {
    return std::any_of(backends_.begin(), backends_.end(), [&](const BackendInfo& info) {
      return info.name == backend && info.problem.empty() && !info.devices.empty();
    });
  }

  bool varies(harness::StudyAxis axis) const {
    const auto& axes = result_.subjects.axes;
    return std::count(axes.begin(), axes.end(), axis) > 0;
  }

  const Options& options_;
  const Workload& workload_;
  const std::vector<BackendInfo>& backends_;
  StudyPlan result_;
};

}  // namespace

StudyPlan plan_study(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends) {
  return Planner(options, workload, backends).plan();
}

std::string command_of(const harness::StudyRun& run, const std::string& scene) {
  const Settings& settings = run.plan.settings;
  std::string text = fmt::format("squall run {} --backend {} --pressure {}", shell_word(scene), run.plan.backend,
                                 to_string(settings.pressure));
  const bool is_reference = run.plan.backend == "reference";
  if ((settings.precision == Precision::double_precision) != is_reference)
    text += fmt::format(" --precision {}", to_string(settings.precision));
  if (!settings.device.empty()) text += " --device " + settings.device;
  if (settings.threads > 0 && !is_reference) text += fmt::format(" --threads {}", settings.threads);
  if (settings.simd != Simd::best) text += fmt::format(" --simd {}", to_string(settings.simd));
  if (run.plan.backend == "opencl") text += fmt::format(" --readback {}", to_string(settings.readback));
  if (settings.seed != 1) text += fmt::format(" --seed {}", settings.seed);
  return text + fmt::format(" --frames {}", run.plan.frames);
}

}  // namespace squall::app
