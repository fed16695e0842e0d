#include "backend_opencl/device.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "backend_opencl/errors.h"
#include "backend_opencl/opencl_backend.h"
#include "core/address_space.h"

namespace squall::opencl {

namespace {

// Every kernel with one work-item per particle runs in groups of this many (buffers.h).
constexpr std::size_t k_smallest_group = 64;

// PoCL 3.1 takes 520 MiB of address space on two cores, compiler included, and ends the process where they run out.
constexpr std::uint64_t k_driver_bytes = std::uint64_t{1} << 30;

std::string kind_of(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  return type & CL_DEVICE_TYPE_GPU ? "gpu" : "accelerator";
}

/// "OpenCL 1.2 ..." and everything after it; 1.0 and 1.1 lack what the kernels use.
bool is_version_1_2(const std::string& version) {
  return version.rfind("OpenCL 1.0", 0) != 0 && version.rfind("OpenCL 1.1", 0) != 0;
}

std::string what_is_missing(const cl::Device& device) {
  if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "the driver says it is not available";
  if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "its driver has no compiler";
  if (!device.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) return "it is big-endian";
  if (!is_version_1_2(device.getInfo<CL_DEVICE_VERSION>())) return "OpenCL 1.2 is needed";
  if (device.getInfo<CL_DEVICE_PROFILE>() != "FULL_PROFILE") return "the full OpenCL profile is needed";
  if (device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>() < k_smallest_group) return "work groups of 64 are needed";
  return "";
}

struct Guarantee {
  cl_device_fp_config bit;
  const char* name;
};
/// What makes the bits of a sum of products the same everywhere.
constexpr Guarantee k_guarantees[] = {
    {CL_FP_FMA, "fused multiply-add"},
    {CL_FP_DENORM, "denormals"},
    {CL_FP_ROUND_TO_NEAREST, "rounding to nearest"},
    {CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT, "correctly rounded division and square root"},
};

std::string lacking_guarantees(cl_device_fp_config config) {
  std::string names;
  for (const Guarantee& guarantee : k_guarantees)
    if ((config & guarantee.bit) == 0) names += std::string(names.empty() ? "" : ", ") + guarantee.name;
  return names;
}

/// Where a device computes in double precision, OpenCL demands all that the promise of bits rests on.
bool computes_in_double(const cl::Device& device) {
  const std::string extensions = " " + device.getInfo<CL_DEVICE_EXTENSIONS>() + " ";
  return extensions.find(" cl_khr_fp64 ") != std::string::npos;
}

DeviceInfo describe(const cl::Platform& platform, const cl::Device& device, int index) {
  DeviceInfo info;
  info.backend = "opencl";
  info.index = index;
  try {
    info.name = device.getInfo<CL_DEVICE_NAME>();
    info.platform = platform.getInfo<CL_PLATFORM_NAME>();
    info.driver = device.getInfo<CL_DRIVER_VERSION>();
    info.version = device.getInfo<CL_DEVICE_VERSION>();
    info.kind = kind_of(device.getInfo<CL_DEVICE_TYPE>());
    info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    info.has_double = computes_in_double(device);
    info.lacks = lacking_guarantees(device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>());
    info.bitwise = info.lacks.empty();
    info.problem = what_is_missing(device);
  } catch (const cl::Error& error) {
    info.problem = device_error(error, info.name).what();
    info.has_double = info.bitwise = false;
  }
  return info;
}

std::vector<cl::Device> devices_of(const cl::Platform& platform) {
  std::vector<cl::Device> devices;
  try {
    platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
  } catch (const cl::Error& error) {
    if (error.err() != CL_DEVICE_NOT_FOUND) throw;
  }
  return devices;
}

std::string no_device_text(const std::vector<cl::Platform>& platforms) {
  std::string names;
  for (const auto& platform : platforms) names += (names.empty() ? "" : ", ") + platform.getInfo<CL_PLATFORM_NAME>();
  if (names.empty()) return "no OpenCL driver offers a device (Debian: apt-get install pocl-opencl-icd)";
  // PoCL says no more than that either.
  return "no OpenCL driver offers a device: " + names +
         " found none (PoCL: where it cannot write its cache; set POCL_CACHE_DIR to a folder that can be written)";
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string list_of(const std::vector<DeviceInfo>& devices) {
  std::string text = "there are:";
  for (const auto& device : devices) text += "\n  " + std::to_string(device.index) + ": " + device.name;
  return text;
}

std::size_t find_wanted(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
  if (wanted.empty()) return 0;
  const bool digits = std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (digits && std::to_string(devices[i].index) == wanted) return i;
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (lower_case(devices[i].name).find(lower_case(wanted)) != std::string::npos) return i;
  return devices.size();
}

/// Part of a device with this many compute units; empty where the device cannot be divided.
cl::Device divide(cl::Device device, int units) {
  const cl_device_partition_property by_counts[] = {CL_DEVICE_PARTITION_BY_COUNTS, units,
                                                    CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
  std::vector<cl::Device> parts;
  try {
    device.createSubDevices(by_counts, &parts);
  } catch (const cl::Error&) {
    return {};
  }
  return parts.empty() ? cl::Device() : parts.front();
}

/// Parts of devices, made once and kept until the process ends, as whole devices are. A worker thread of PoCL 3.1 still
/// reads the device of an event after it has called it complete, and nothing tells when it is done: a part that went
/// with its solver would now and then be gone by then.
class KeptParts {
 public:
  cl::Device part_of(const cl::Device& device, int units) {
    const std::lock_guard lock(mutex_);
    cl::Device& part = parts_[{device(), units}];
    if (part() == nullptr) part = divide(device, units);
    return part;
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<cl_device_id, int>, cl::Device> parts_;
};

KeptParts& kept_parts() {
  // Never destroyed: drivers may be gone when static objects are.
  static KeptParts* const parts = new KeptParts;
  return *parts;
}

/// Part of a CPU device with this many compute units; the whole where the device cannot be divided.
cl::Device limit_threads(const cl::Device& device, int threads) {
  const auto units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  if (threads <= 0 || static_cast<cl_uint>(threads) >= units) return device;
  const cl::Device part = kept_parts().part_of(device, threads);
  return part() == nullptr ? device : part;
}

/// What is needed rounds up, what there is rounds down: never the same number for too much and enough.
[[noreturn]] void throw_too_large(const Machine& machine, const std::string& what, cl_ulong need, cl_ulong limit) {
  throw DeviceError(machine.info.name + " cannot hold the scene: " + what + " need " +
                    std::to_string((need + (1 << 20) - 1) >> 20) + " MiB" + ", the device allows " +
                    std::to_string(limit >> 20) +
                    " MiB; use fewer particles, a larger spacing, a smaller container or another --device");
}

}  // namespace

std::vector<FoundDevice> find_devices(std::string* problem) {
  std::vector<FoundDevice> found;
  std::string why = address_space_problem("an OpenCL driver", k_driver_bytes);
  if (!why.empty()) {
    if (problem) *problem = why;
    return found;
  }
  try {
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    for (const auto& platform : platforms)
      for (const auto& device : devices_of(platform))
        found.push_back({device, describe(platform, device, static_cast<int>(found.size()))});
    if (found.empty()) why = no_device_text(platforms);
  } catch (const cl::Error& error) {
    why = device_error(error, "").what();
  } catch (const std::exception& error) {
    why = error.what();
  }
  if (problem) *problem = found.empty() ? why : "";
  return found;
}

std::vector<DeviceInfo> devices(std::string* problem) {
  std::vector<DeviceInfo> infos;
  for (const auto& found : find_devices(problem)) infos.push_back(found.info);
  return infos;
}

std::size_t choose_device(const std::vector<DeviceInfo>& devices, const std::string& wanted,
                          const std::string& problem) {
  if (devices.empty()) throw DeviceError("no OpenCL device: " + problem);
  const std::size_t chosen = find_wanted(devices, wanted);
  if (chosen == devices.size())
    throw DeviceError("no OpenCL device has the index or the name \"" + wanted + "\"; " + list_of(devices));
  if (!devices[chosen].problem.empty())
    throw DeviceError("OpenCL device " + devices[chosen].name + " cannot run: " + devices[chosen].problem + "; " +
                      list_of(devices));
  return chosen;
}

void check_precision(const DeviceInfo& device, Precision precision) {
  if (precision == Precision::double_precision && !device.has_double)
    throw DeviceError("OpenCL device " + device.name +
                      " does not compute in double precision: it lacks the extension cl_khr_fp64; drop --precision "
                      "double or pick another --device");
}

Machine open_machine(const Settings& settings) {
  std::string problem;
  const std::vector<FoundDevice> found = find_devices(&problem);
  std::vector<DeviceInfo> infos;
  for (const auto& one : found) infos.push_back(one.info);
  const FoundDevice& chosen = found[choose_device(infos, settings.device, problem)];
  check_precision(chosen.info, settings.precision);
  return translate_errors(chosen.info.name, [&] {
    Machine machine;
    machine.info = chosen.info;
    machine.is_cpu = chosen.info.kind == "cpu";
    machine.device = machine.is_cpu ? limit_threads(chosen.device, settings.threads) : chosen.device;
    machine.compute_units = static_cast<int>(machine.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    machine.rounds_correctly =
        (machine.device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    machine.context = cl::Context(machine.device);
    machine.queue = cl::CommandQueue(
        machine.context, machine.device,
        settings.profile || settings.trace ? cl_command_queue_properties{CL_QUEUE_PROFILING_ENABLE} : 0);
    return machine;
  });
}

namespace {

struct Excess {
  const char* what;
  cl_ulong bytes, limit;
};

std::optional<Excess> find_excess(const Machine& machine, const std::vector<MemoryNeed>& needs) {
  const auto largest = machine.device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  const auto constant = machine.device.getInfo<CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE>();
  const auto all = machine.device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  cl_ulong sum = 0;
  for (const auto& need : needs) {
    const cl_ulong limit = need.constant ? constant : largest;
    if (need.bytes > limit) return Excess{need.what, need.bytes, limit};
    sum += need.bytes;
  }
  if (sum > all) return Excess{"all buffers together", sum, all};
  return std::nullopt;
}

}  // namespace

bool fits(const Machine& machine, const std::vector<MemoryNeed>& needs) { return !find_excess(machine, needs); }

void check_limits(const Machine& machine, const std::vector<MemoryNeed>& needs) {
  if (const auto excess = find_excess(machine, needs))
    throw_too_large(machine, excess->what, excess->bytes, excess->limit);
}

}  // namespace squall::opencl
