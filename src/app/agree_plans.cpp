#include "app/agree_plans.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/device_choice.h"
#include "app/plans.h"
#include "core/errors.h"

namespace squall::app {

namespace {

using harness::Subject;

/// The plans of compare know which backends and devices there are and which cannot run: one of each.
Plans one_of_each(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends) {
  Options one = options;
  one.threads = {1};
  one.simd.reset();
  one.precision.reset();
  one.readbacks = {Readback::mapped};
  std::erase(one.backends, "reference");
  if (one.backends.empty() && !options.backends.empty()) return {};
  return plan_comparison(one, workload, backends);
}

/// Whether this machine can run it; why not, if a width cannot be had.
std::string refusal_of(const harness::RunPlan& plan, const Workload& workload) {
  Workload few = workload;
  few.scene.blocks.clear();
  few.scene.boxes.clear();
  few.scene.rains.clear();
  few.scene.particle_files.clear();
  try {
    make_solver(plan.backend, few.scene, plan.settings);
  } catch (const DeviceError& refusal) {
    return refusal.what();
  }
  return "";
}

class Planner {
 public:
  Planner(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends)
      : options_(options), workload_(workload), backends_(backends) {}

  AgreePlans plan() {
    add_reference();
    const Plans plans = one_of_each(options_, workload_, backends_);
    result_.left_out = plans.left_out;
    for (const auto& plan : plans.plans) {
      const DeviceInfo& device = device_of(plan, backends_);
      if (plan.backend == "omp")
        add_omp(plan, device);
      else
        add_opencl(plan, device);
    }
    return std::move(result_);
  }

 private:
  void add_reference() {
    harness::RunPlan plan;
    plan.label = "reference, single";
    plan.backend = "reference";
    plan.settings.pressure = workload_.pressure;
    plan.settings.seed = options_.seed;
    result_.subjects.push_back({plan, ""});
  }

  /// As asked, else those of this machine: one, all, and three, which divide hardly anything evenly.
  std::vector<int> thread_counts(const DeviceInfo& device) const {
    if (!options_.threads.empty()) return options_.threads;
    std::vector<int> counts{1, std::max(1, device.compute_units)};
    if (device.backend == "omp") counts.push_back(3);
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
  }

  std::vector<Simd> widths() const {
    if (!options_.simds.empty()) return options_.simds;
    return {Simd::scalar, Simd::avx2, Simd::avx512};
  }

  void add_omp(const harness::RunPlan& base, const DeviceInfo& device) {
    const std::vector<int> counts = thread_counts(device);
    const int most = *std::max_element(counts.begin(), counts.end());
    for (const Simd simd : widths()) {
      harness::RunPlan plan = base;
      plan.settings.simd = simd;
      plan.settings.threads = most;
      if (const std::string refusal = refusal_of(plan, workload_); !refusal.empty()) {
        if (!options_.simds.empty()) throw DeviceError("omp: " + refusal);
        result_.left_out.push_back(fmt::format("omp with {} is left out: {}", to_string(simd), refusal));
        continue;
      }
      plan.label = fmt::format("omp, {}, {}", threads_text(most), to_string(simd));
      result_.subjects.push_back({plan, device.lacks});
    }
    for (const int threads : counts) {
      if (threads == most) continue;  // done, with every width
      harness::RunPlan plan = base;
      plan.settings.threads = threads;
      if (!options_.simds.empty()) plan.settings.simd = options_.simds.front();
      plan.label = "omp, " + threads_text(threads);
      result_.subjects.push_back({plan, device.lacks});
    }
  }

  /// A GPU has its own way to be used and no threads to choose.
  void add_opencl(const harness::RunPlan& base, const DeviceInfo& device) {
    const bool cpu = device.kind == "cpu";
    harness::RunPlan plan = base;
    plan.settings.threads = 0;
    const std::string name = fmt::format("opencl {}", device.index);
    const bool all_widths = cpu || !options_.simds.empty();
    for (const Simd simd : all_widths ? widths() : std::vector<Simd>{Simd::best}) {
      plan.settings.simd = simd;
      plan.label = name + lanes_text(simd);
      result_.subjects.push_back({plan, device.lacks});
    }
    if (!cpu) return;
    plan.settings.simd = options_.simds.empty() ? Simd::best : options_.simds.front();
    for (const int threads : thread_counts(device)) {
      if (threads == device.compute_units && options_.threads.empty()) continue;  // the whole device is there already
      plan.settings.threads = threads;
      plan.label = fmt::format("{}{}, {}", name, lanes_text(plan.settings.simd), threads_text(threads));
      result_.subjects.push_back({plan, device.lacks});
    }
  }

  static std::string threads_text(int threads) { return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"); }
  static std::string lanes_text(Simd simd) {
    if (simd == Simd::best) return "";
    return simd == Simd::scalar ? ", particles" : simd == Simd::avx2 ? ", float8" : ", float16";
  }

  const Options& options_;
  const Workload& workload_;
  const std::vector<BackendInfo>& backends_;
  AgreePlans result_;
};

}  // namespace

AgreePlans plan_agreement(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends) {
  return Planner(options, workload, backends).plan();
}

}  // namespace squall::app
