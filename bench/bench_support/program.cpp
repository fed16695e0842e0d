#include "bench_support/program.h"

#include <benchmark/benchmark.h>

#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "backends.h"
#include "harness/context.h"

namespace squall::bench {

namespace {

const char* to_string(Effort effort) {
  return effort == Effort::smoke ? "smoke" : effort == Effort::quick ? "quick" : "full";
}

/// Takes ours out of the arguments.
Effort take_effort(std::vector<std::string>& arguments) {
  Effort effort = Effort::full;
  std::erase_if(arguments, [&](const std::string& argument) {
    for (const Effort one : {Effort::smoke, Effort::quick, Effort::full})
      if (argument == std::string("--") + to_string(one)) {
        effort = one;
        return true;
      }
    return false;
  });
  return effort;
}

void add_context(Effort effort) {
  const harness::Context context = harness::collect_context();
  benchmark::AddCustomContext("squall_version", context.squall_version);
  benchmark::AddCustomContext("git_revision", context.git_revision);
  benchmark::AddCustomContext("cpu", context.cpu);
  benchmark::AddCustomContext("cores", std::to_string(context.cores));
  benchmark::AddCustomContext("compiler", context.compiler);
  benchmark::AddCustomContext("flags", context.flags);
  benchmark::AddCustomContext("effort", to_string(effort));
  for (const auto& backend : list_backends())
    if (backend.name == "opencl")
      for (const auto& device : backend.devices)
        benchmark::AddCustomContext("opencl_" + std::to_string(device.index),
                                    device.name + "; " + device.platform + " " + device.driver + "; " + device.version);
}

}  // namespace

int run_program(int argc, char** argv, const std::function<void(Effort)>& add_rows,
                const std::function<bool()>& has_failed) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const Effort effort = take_effort(arguments);
  const int repetitions = effort == Effort::smoke ? 1 : effort == Effort::quick ? 3 : 7;
  const std::vector<std::string> defaults{argv[0], "--benchmark_repetitions=" + std::to_string(repetitions),
                                          "--benchmark_enable_random_interleaving=true",
                                          "--benchmark_display_aggregates_only=true"};
  arguments.insert(arguments.begin(), defaults.begin(), defaults.end());
  std::vector<char*> words;
  for (auto& argument : arguments) words.push_back(argument.data());
  int count = static_cast<int>(words.size());
  words.push_back(nullptr);
  try {
    benchmark::Initialize(&count, words.data());
    if (benchmark::ReportUnrecognizedArguments(count, words.data())) return 2;
    add_context(effort);
    add_rows(effort);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
  }
  return has_failed() ? 1 : 0;
}

}  // namespace squall::bench
