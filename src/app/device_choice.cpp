#include "app/device_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/errors.h"

namespace squall::app {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_index(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

const BackendInfo& find_backend(const std::vector<BackendInfo>& backends, const std::string& name) {
  const auto found =
      std::find_if(backends.begin(), backends.end(), [&](const BackendInfo& info) { return info.name == name; });
  if (found == backends.end()) throw DeviceError("backend '" + name + "' is unknown to this build");
  return *found;
}

std::string problem_of(const BackendInfo& backend) {
  if (!backend.problem.empty()) return backend.problem;
  std::string problems;
  for (const auto& device : backend.devices) {
    if (device.problem.empty()) return "";
    problems += fmt::format("{}{} {}: {}", problems.empty() ? "" : "; ", device.index, device.name, device.problem);
  }
  return problems.empty() ? "no device" : problems;
}

std::vector<DeviceInfo> select_devices(const BackendInfo& backend, const std::string& text) {
  std::vector<DeviceInfo> selected;
  std::string names;
  for (const auto& device : backend.devices) {
    const bool matches = is_index(text) ? std::to_string(device.index) == text
                                        : lower(device.name).find(lower(text)) != std::string::npos;
    if (matches) selected.push_back(device);
    names += fmt::format("{}{} {}", names.empty() ? "" : ", ", device.index, device.name);
  }
  if (selected.empty())
    throw DeviceError(
        fmt::format("{} has no device '{}'; it has {}", backend.name, text, names.empty() ? "none" : names));
  return selected;
}

std::string problem_in(const DeviceInfo& device, Precision precision) {
  if (!device.problem.empty()) return device.problem;
  if (precision == Precision::single_precision || device.has_double) return "";
  return "it does not compute in double precision (OpenCL: it lacks the extension cl_khr_fp64)";
}

bool promises_bits(const DeviceInfo& device, Precision precision) {
  return precision == Precision::single_precision ? device.bitwise : device.has_double;
}

Precision precision_of(const Options& options, const std::string& backend) {
  return options.precision.value_or(backend == "reference" ? Precision::double_precision : Precision::single_precision);
}

const DeviceInfo& device_of(const harness::RunPlan& plan, const std::vector<BackendInfo>& backends) {
  const BackendInfo& backend = find_backend(backends, plan.backend);
  for (const auto& device : backend.devices)
    if (plan.backend != "opencl" || std::to_string(device.index) == plan.settings.device) return device;
  throw DeviceError("backend " + plan.backend + " has no device " + plan.settings.device);
}

}  // namespace squall::app
