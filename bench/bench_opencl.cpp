// The opencl backend: whole steps by device and read-back mode, stages by profiled events.
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends.h"
#include "bench_support/device_probe.h"
#include "bench_support/program.h"
#include "bench_support/solver_rows.h"

namespace {

using namespace squall;
using namespace squall::bench;

constexpr Readback k_readbacks[] = {Readback::none,   Readback::blocking, Readback::pinned,
                                    Readback::mapped, Readback::async,    Readback::quantized};

/// Particles per vector that the solver takes on a device, by SolverInfo::simd: "scalar", "float8", "float16".
int lanes_of(const DeviceInfo& device, const Scene& scene) {
  Settings settings;
  settings.device = std::to_string(device.index);
  const std::string simd = make_solver("opencl", scene, settings)->info().simd;
  return simd == "float16" ? 16 : simd == "float8" ? 8 : 1;
}

class Bench {
 public:
  explicit Bench(Effort effort)
      : cases_(effort),
        rows_(cases_, [this](const Variant& variant, std::size_t bytes) { return bounds(variant, bytes); }) {
    std::string problem;
    for (const auto& backend : list_backends()) {
      if (backend.name != "opencl") continue;
      problem = backend.problem;
      for (const auto& device : backend.devices)
        if (device.problem.empty()) add_device(device);
    }
    if (!any_) throw DeviceError("no OpenCL device can run" + (problem.empty() ? "" : ": " + problem));
  }
  bool failed() const { return rows_.failed(); }

 private:
  void add_device(const DeviceInfo& device) {
    any_ = true;
    const int lanes = lanes_of(device, cases_.get(Pressure::wcsph, sizes_for(cases_.effort()).front()).scene);
    for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller})
      for (const Size size : sizes_for(cases_.effort()))
        for (const Readback readback : k_readbacks) {
          const Variant variant = variant_of(device, readback, lanes);
          rows_.add_step(pressure, size, variant);
          if (readback == Readback::none) rows_.add_stages(pressure, size, variant);
        }
  }

  static Variant variant_of(const DeviceInfo& device, Readback readback, int lanes) {
    Variant variant;
    const std::string index = std::to_string(device.index);
    variant.name = "opencl:" + index + "/" + to_string(readback);
    variant.backend = "opencl";
    variant.settings.device = index;
    variant.settings.readback = readback;
    variant.walk = {lanes, Way::every_candidate};
    variant.strict = device.bitwise;
    return variant;
  }

  Bounds bounds(const Variant& variant, std::size_t bytes) {
    const double seconds = cases_.effort() == Effort::smoke ? 1e-4 : 1e-3;
    return probes_.try_emplace(variant.settings.device, variant.settings, variant.walk.lanes, seconds)
        .first->second.measure(bytes);
  }

  Cases cases_;
  SolverRows rows_;
  std::map<std::string, DeviceProbe> probes_;  ///< by device
  bool any_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  std::unique_ptr<Bench> bench;
  return squall::bench::run_program(
      argc, argv, [&](Effort effort) { bench = std::make_unique<Bench>(effort); }, [&] { return bench->failed(); });
}
