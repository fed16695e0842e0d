#include "backend_opencl/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "backend_opencl/device.h"
#include "backend_opencl/errors.h"
#include "backend_opencl/passes.h"

namespace squall::opencl {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string build_error(const std::vector<KernelSource>& sources, const std::string& options) {
  const Machine machine = open_machine(Settings{});
  try {
    build_program(machine.context, machine.device, sources, options);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "it builds";
}

TEST(Program, SaysWhatTheCompilerSaid) {
  const KernelSource broken{"broken.cl", "__kernel void broken(__global int* a) { a[0] = no_such_thing; }"};
  const std::string text = build_error({broken}, "-cl-std=CL1.2 -DSQUALL_MARK=7");
  EXPECT_THAT(text, HasSubstr("no_such_thing"));
  EXPECT_THAT(text, HasSubstr("CL_BUILD_PROGRAM_FAILURE"));
  EXPECT_THAT(text, HasSubstr("-DSQUALL_MARK=7"));
}

TEST(Program, NamesTheFileAndLineWrittenByHand) {
  auto sources = embedded_kernels();
  const auto density = std::find_if(sources.begin(), sources.end(), [](const auto& source) {
    return std::string(source.file) == "kernels/density.cl";
  });
  ASSERT_NE(density, sources.end());
  const std::string text = density->text;
  const std::string spoilt = text + "\nint spoilt = no_such_thing;\n";
  // The embedded text says last which line of the file comes next.
  const auto directive = text.rfind("#line ");
  const auto next = text.find('\n', directive) + 1;
  const auto line = std::stol(text.substr(directive + 6)) +
                    std::count(text.begin() + static_cast<std::ptrdiff_t>(next), text.end(), '\n') + 1;
  EXPECT_LT(line, 100) << "density.cl is a short file: these are lines of its headers";
  EXPECT_THAT(build_error({{"kernels/density.cl", spoilt.c_str()}}, "-cl-std=CL1.2"),
              HasSubstr("kernels/density.cl:" + std::to_string(line)));
}

// Compilers may print how many there were, in the middle of a program's output.
TEST(Program, BuildsWithoutAWarning) {
  const Machine machine = open_machine(Settings{});
  // No driver has kept what was built with this mark: it is compiled now.
  const std::string mark =
      " -DSQUALL_MARK=" + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
  for (const int lanes : {1, 8, 16})
    for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph}) {
      Scene scene;
      scene.boxes.emplace_back();
      scene.rains.emplace_back();
      Settings settings;
      settings.pressure = pressure;
      WorkShape shape;
      shape.lanes = lanes;
      shape.weights = pressure == Pressure::dfsph && lanes > 1;
      const std::string options = build_options(scene, settings, machine.rounds_correctly, shape);
      const cl::Program program = build_program(machine.context, machine.device, embedded_kernels(), options + mark);
      EXPECT_THAT(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(machine.device), Not(HasSubstr("warning"))) << options;
    }
}

TEST(Program, EmbedsEveryHeader) {
  const auto sources = embedded_kernels();
  ASSERT_FALSE(sources.empty());
  for (const auto& source : sources) {
    EXPECT_THAT(source.text, HasSubstr("__kernel"));
    EXPECT_THAT(source.text, Not(HasSubstr("#include \""))) << source.file;
  }
}

TEST(Errors, CarryCallCodeAndCause) {
  const std::string text =
      device_error(cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clCreateBuffer"), "Toaster").what();
  EXPECT_THAT(text, HasSubstr("clCreateBuffer"));
  EXPECT_THAT(text, HasSubstr("CL_MEM_OBJECT_ALLOCATION_FAILURE (-4)"));
  EXPECT_THAT(text, HasSubstr("Toaster"));
  EXPECT_THAT(text, HasSubstr("memory"));
  EXPECT_THAT(error_name(-12345), HasSubstr("-12345"));
}

}  // namespace
}  // namespace squall::opencl
