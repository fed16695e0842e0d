#include "backend_opencl/program.h"

#include <new>

#include "backend_opencl/errors.h"

namespace squall::opencl {

namespace {

/// What the compiler said; nothing where the driver, failing, has no log either.
std::string build_log(const cl::Program& program, const cl::Device& device) {
  try {
    return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
  } catch (const cl::Error&) {
    return "";
  }
}

}  // namespace

cl::Program build_program(const cl::Context& context, const cl::Device& device,
                          const std::vector<KernelSource>& sources, const std::string& options) {
  cl::Program::Sources texts;
  for (const auto& source : sources) texts.emplace_back(source.text);
  cl::Program program(context, texts);
  // Not by cl::Program::build(), which would report a log that cannot be had in place of why the build failed.
  const cl_device_id id = device();
  cl_int code = CL_SUCCESS;
  try {
    code = ::clBuildProgram(program(), 1, &id, options.c_str(), nullptr, nullptr);
  } catch (const std::bad_alloc&) {
    program() =
        nullptr;  // PoCL, through which it came, still holds the program's lock: to release it would wait for ever
    throw DeviceError(device.getInfo<CL_DEVICE_NAME>() + " ran out of memory building the kernels");
  }
  if (code == CL_SUCCESS) return program;
  throw DeviceError(std::string("the kernels do not build on ") + device.getInfo<CL_DEVICE_NAME>() + ": " +
                    error_name(code) + " with options \"" + options + "\"\n" + build_log(program, device));
}

}  // namespace squall::opencl
