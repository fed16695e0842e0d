#include "backend_opencl/program.h"

#include "backend_opencl/errors.h"

namespace squall::opencl {

cl::Program build_program(const cl::Context& context, const cl::Device& device,
                          const std::vector<KernelSource>& sources, const std::string& options) {
  cl::Program::Sources texts;
  for (const auto& source : sources) texts.emplace_back(source.text);
  cl::Program program(context, texts);
  try {
    program.build(std::vector<cl::Device>{device}, options.c_str());
  } catch (const cl::BuildError& error) {
    std::string text = std::string("the kernels do not build on ") + device.getInfo<CL_DEVICE_NAME>() + ": " +
                       error_name(error.err()) + " with options \"" + options + "\"";
    for (const auto& log : error.getBuildLog()) text += "\n" + log.second;
    throw DeviceError(text);
  }
  return program;
}

}  // namespace squall::opencl
