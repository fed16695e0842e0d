#include "backend_opencl/errors.h"

#include <array>

namespace squall::opencl {

namespace {

// Of the extension cl_khr_icd: there is no driver to ask.
constexpr cl_int k_platform_not_found = -1001;

struct KnownError {
  cl_int code;
  const char* name;
  const char* cause;
};

constexpr const char* k_lost = "the device may have been lost, or a kernel ran too long or out of bounds";
constexpr const char* k_no_room = "not enough memory is free; use fewer particles, or close what else uses the device";
constexpr const char* k_driver = "the driver refused what the specification allows; another driver version may help";

constexpr KnownError k_errors[] = {
    {CL_DEVICE_NOT_FOUND, "CL_DEVICE_NOT_FOUND", "the driver offers no device"},
    {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE", "another process owns the device, or it was lost"},
    {CL_COMPILER_NOT_AVAILABLE, "CL_COMPILER_NOT_AVAILABLE", "the driver was installed without its compiler"},
    {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE", k_no_room},
    {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES", k_lost},
    {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY", "the host has no memory left; use fewer particles"},
    {CL_PROFILING_INFO_NOT_AVAILABLE, "CL_PROFILING_INFO_NOT_AVAILABLE", k_driver},
    {CL_MAP_FAILURE, "CL_MAP_FAILURE", "the buffer cannot be mapped; choose another --readback"},
    {CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST", k_lost},
    {CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE", k_driver},
    {CL_INVALID_VALUE, "CL_INVALID_VALUE", k_driver},
    {CL_INVALID_DEVICE, "CL_INVALID_DEVICE", k_driver},
    {CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT", k_lost},
    {CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE", k_lost},
    {CL_INVALID_MEM_OBJECT, "CL_INVALID_MEM_OBJECT", k_driver},
    {CL_INVALID_BUILD_OPTIONS, "CL_INVALID_BUILD_OPTIONS", k_driver},
    {CL_INVALID_KERNEL_NAME, "CL_INVALID_KERNEL_NAME", k_driver},
    {CL_INVALID_KERNEL_ARGS, "CL_INVALID_KERNEL_ARGS", k_driver},
    {CL_INVALID_ARG_INDEX, "CL_INVALID_ARG_INDEX", k_driver},
    {CL_INVALID_ARG_VALUE, "CL_INVALID_ARG_VALUE", k_driver},
    {CL_INVALID_ARG_SIZE, "CL_INVALID_ARG_SIZE", k_driver},
    {CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE", k_driver},
    {CL_INVALID_GLOBAL_WORK_SIZE, "CL_INVALID_GLOBAL_WORK_SIZE", k_driver},
    {CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE", k_no_room},
    {CL_INVALID_DEVICE_PARTITION_COUNT, "CL_INVALID_DEVICE_PARTITION_COUNT", "the device has fewer compute units"},
    {k_platform_not_found, "CL_PLATFORM_NOT_FOUND_KHR", "no OpenCL driver is installed (Debian: pocl-opencl-icd)"},
};

const KnownError* find(cl_int code) {
  for (const auto& known : k_errors)
    if (known.code == code) return &known;
  return nullptr;
}

}  // namespace

std::string error_name(cl_int code) {
  const KnownError* known = find(code);
  return (known ? std::string(known->name) : std::string("OpenCL error")) + " (" + std::to_string(code) + ")";
}

DeviceError device_error(const cl::Error& error, const std::string& device) {
  const KnownError* known = find(error.err());
  std::string text = std::string(error.what()) + " failed with " + error_name(error.err());
  if (!device.empty()) text += " on " + device;
  return DeviceError(text + ": " + (known ? known->cause : k_driver));
}

}  // namespace squall::opencl
