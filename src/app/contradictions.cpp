#include "app/contradictions.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/exit_codes.h"

namespace squall::app {

namespace {

/// The backends that take part as far as the options say.
std::vector<std::string> backends_of(const Options& options) {
  if (!options.backends.empty()) return options.backends;
  if (options.command == Command::validate && options.device.empty()) return {"omp", "opencl", "reference"};
  if (options.command != Command::run && options.command != Command::validate) return {"omp", "opencl"};
  return {options.device.empty() ? "omp" : "opencl"};
}

bool takes_part(const Options& options, const std::string& backend) {
  const auto backends = backends_of(options);
  return std::count(backends.begin(), backends.end(), backend) > 0;
}

bool only_reference(const Options& options) { return !takes_part(options, "omp") && !takes_part(options, "opencl"); }

bool several_threads(const Options& options) {
  return std::any_of(options.threads.begin(), options.threads.end(), [](int threads) { return threads != 1; });
}

}  // namespace

std::vector<std::string> drop_contradicted_variables(const IsFlag& is_flag, Options& options) {
  std::vector<std::string> notes;
  const auto note = [&](const char* variable, const std::string& other) {
    notes.push_back(fmt::format("{} is left out: it contradicts {}", variable, other));
  };
  const auto forget_idle_table = [&] {  // the variable says where a file lies, whatever runs
    if (!is_flag("--tuning") && !takes_part(options, "opencl")) options.tuning.clear();
  };
  if (!options.backends.empty() && !is_flag("--backend")) {
    const bool other_device = is_flag("--device") && !takes_part(options, "opencl");
    const bool other_kind =
        (is_flag("--simd") || (is_flag("--threads") && several_threads(options))) && only_reference(options);
    if (!other_device && !other_kind) {
      forget_idle_table();
      return notes;
    }
    note("SQUALL_BACKEND", other_device ? "--device" : is_flag("--simd") ? "--simd" : "--threads");
    options.backends.clear();
  }
  const std::string backend = fmt::format("backend {}", fmt::join(backends_of(options), ", "));
  const auto drop = [&](const char* option, const char* variable, bool contradicted, auto& value) {
    if (!contradicted || is_flag(option)) return;
    note(variable, backend);
    value = {};
  };
  forget_idle_table();
  const bool no_opencl = !takes_part(options, "opencl");
  drop("--device", "SQUALL_DEVICE", no_opencl && !options.device.empty(), options.device);
  drop("--readback", "SQUALL_READBACK", no_opencl && !options.readbacks.empty(), options.readbacks);
  drop("--tune", "SQUALL_TUNE", no_opencl && options.tune, options.tune);
  drop("--threads", "SQUALL_THREADS", only_reference(options) && several_threads(options), options.threads);
  drop("--simd", "SQUALL_SIMD", only_reference(options) && options.simd.has_value(), options.simd);
  return notes;
}

void check_contradictions(const Options& options) {
  const std::string backends = fmt::format("{}", fmt::join(backends_of(options), ", "));
  if (!takes_part(options, "opencl")) {
    if (!options.device.empty())
      throw UsageError(fmt::format(
          "--device picks an OpenCL device; {} has none to pick: leave it out or add --backend opencl", backends));
    if (!options.readbacks.empty())
      throw UsageError(fmt::format(
          "--readback belongs to the backend opencl; {} delivers in place: leave it out or add --backend opencl",
          backends));
    if (options.tune)
      throw UsageError(
          fmt::format("--tune measures OpenCL devices; {} has none: leave it out or add --backend opencl", backends));
    if (!options.tuning.empty())
      throw UsageError(fmt::format(
          "--tuning names the work sizes of OpenCL devices; {} has none: leave it out or add --backend opencl",
          backends));
  }
  if (!only_reference(options)) return;
  if (options.simd || !options.simds.empty())
    throw UsageError("--simd belongs to the backends omp and opencl; reference has no such choice");
  if (several_threads(options))
    throw UsageError("backend reference has one thread; leave --threads out or pick another --backend");
  if (options.command == Command::agree)
    throw UsageError(
        "agree holds backends against the reference, which always takes part; reference alone leaves nothing to "
        "compare: name omp or opencl too, or leave --backend out");
}

}  // namespace squall::app
