#include <gtest/gtest.h>

#include "app/program.h"

namespace squall::app {
namespace {

/// A command line that cannot be carried out: exit code 2, nothing on stdout, the reason on stderr.
void expect_usage_error(const std::vector<std::string>& arguments, const std::string& reason,
                        const Environment& environment = {}) {
  const Outcome outcome = squall(arguments, environment);
  EXPECT_EQ(outcome.code, 2) << reason;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
}

TEST(Usage, HelpAndVersionAreFine) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"--help"}, {"run", "--help"}, {"--version"}}) {
    const Outcome outcome = squall(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("squall"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
  }
}

// What runs where neither an option nor the scene says a solver.
TEST(Usage, HelpNamesTheSolverThatIsTheDefault) {
  const Outcome scene = squall({"run", k_tiny, "--print-scene"});
  ASSERT_EQ(scene.code, 0) << scene.err;
  const std::string key = "pressure = \"";
  const std::size_t begin = scene.out.find(key) + key.size();
  const std::string name = scene.out.substr(begin, scene.out.find('"', begin) - begin);
  ASSERT_FALSE(name.empty());
  for (const char* command : {"run", "compare", "sweep", "agree"}) {
    const std::string help = squall({command, "--help"}).out;
    EXPECT_NE(help.find("else what the scene says, else " + name + "\n"), std::string::npos) << command << help;
  }
}

TEST(Usage, CommandsThatAreNotThere) {
  expect_usage_error({}, "a command is missing");
  expect_usage_error({"rum"}, "'rum' is unknown");
  for (const char* later : {"cost", "view"}) expect_usage_error({later, k_tiny, "--anything"}, "not in this version");
}

TEST(Usage, OptionsThatAreNotThere) {
  expect_usage_error({"run", k_tiny, "--bogus"}, "--bogus");
  expect_usage_error({"devices", "--frames", "3"}, "--frames");
  expect_usage_error({"sweep", k_tiny, "--trace", "trace.json"}, "--trace");
  expect_usage_error({"sweep", k_tiny, "--tune"}, "--tune");
  for (const std::string later : {"--fast-math", "--tolerance=1", "--max-error=1"}) {
    expect_usage_error({"run", k_tiny, "--backend", "reference", later}, "not in this version");
    expect_usage_error({"compare", k_tiny, later}, "not in this version");
  }
}

TEST(Usage, ValuesThatAreNotThere) {
  expect_usage_error({"compare", k_tiny, "--readback", "none,psychic"}, "pinned, mapped, async, quantized");
  expect_usage_error({"run", k_tiny, "--precision", "half"}, "single, double");
  expect_usage_error({"run", k_tiny, "--backend", "cuda"}, "reference, omp, opencl");
  expect_usage_error({"run", k_tiny, "--pressure", "magic"}, "mueller, wcsph, dfsph");
  expect_usage_error({"run", k_tiny, "--format", "xml"}, "google-benchmark");
}

TEST(Usage, ValuesOutOfRange) {
  expect_usage_error({"run", k_tiny, "--frames", "0"}, "--frames");
  expect_usage_error({"run", k_tiny, "--frames", "many"}, "--frames");
  expect_usage_error({"run", k_tiny, "--threads", "-1"}, "--threads");
  expect_usage_error({"run", k_tiny, "--seconds", "0"}, "--seconds");
  expect_usage_error({"run", k_tiny, "--budget-ms", "-3"}, "--budget-ms");
  expect_usage_error({"run"}, "scene");
  for (const char* value : {"0", "-1", "nan", "inf", "1e999", "soon"})
    for (const char* option : {"--seconds", "--budget-ms"})
      expect_usage_error({"run", k_tiny, option, value}, std::string(option) + ": '" + value + "'");
  for (const char* value : {"0", "nan", "-1", "1.5", "1e-8"})
    expect_usage_error({"run", k_tiny, "--dt-max", value}, "--dt-max: '" + std::string(value) + "'");
  for (const char* value : {"-1", "1.5", "18446744073709551616", "99999999999999999999"})
    expect_usage_error({"run", k_tiny, "--seed", value}, "[0, 18446744073709551615]");
  EXPECT_EQ(squall({"run", k_tiny, "--seed", "18446744073709551615", "--print-scene"}).code, 0);
  for (const char* value : {"0", "268435457", "2147483648"})
    expect_usage_error({"run", k_tiny, "--particles", value}, "--particles");
}

TEST(Usage, OptionsThatContradictEachOther) {
  expect_usage_error({"run", k_tiny, "--frames", "3", "--seconds", "1"}, "--seconds");
  expect_usage_error({"run", k_tiny, "--save-every", "3"}, "--out");
  expect_usage_error({"run", k_tiny, "--backend", "reference", "--device", "0"}, "--device");
  expect_usage_error({"run", k_tiny, "--backend", "reference", "--simd", "avx2"}, "--simd");
}

TEST(Usage, AValueIsNotEmpty) {
  for (const char* option : {"--json", "--out", "--device", "--backend", "--simd", "--pressure"})
    expect_usage_error({"run", k_tiny, "--frames", "1", option, ""}, std::string(option));
}

TEST(Usage, OptionsOfBackendsThatDoNotTakePart) {
  for (const char* command : {"run", "compare"}) {
    expect_usage_error({command, k_tiny, "--backend", "omp", "--device", "7"}, "--device");
    expect_usage_error({command, k_tiny, "--backend", "omp", "--readback", "async"}, "--readback");
    expect_usage_error({command, k_tiny, "--backend", "reference", "--threads", "2"}, "--threads");
    expect_usage_error({command, k_tiny, "--backend", "reference", "--simd", "scalar"}, "--simd");
  }
}

TEST(Usage, AFlagBeatsAVariableThatContradictsIt) {
  struct Case {
    std::string variable, value;
    std::vector<std::string> flags;
  };
  for (const auto& [variable, value, flags] : std::vector<Case>{{"SQUALL_DEVICE", "0", {"--backend", "reference"}},
                                                                {"SQUALL_READBACK", "none", {"--backend", "omp"}},
                                                                {"SQUALL_THREADS", "2", {"--backend", "reference"}},
                                                                {"SQUALL_SIMD", "scalar", {"--backend", "reference"}},
                                                                {"SQUALL_BACKEND", "omp", {"--device", "0"}},
                                                                {"SQUALL_BACKEND", "reference", {"--threads", "2"}}}) {
    std::vector<std::string> arguments{"run", k_tiny, "--frames", "1"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Outcome outcome = squall(arguments, {{variable, value}});
    EXPECT_EQ(outcome.code, 0) << variable << outcome.err;
    EXPECT_NE(outcome.err.find(variable + " is left out"), std::string::npos) << outcome.err;
  }
  expect_usage_error({"run", k_tiny}, "--device", {{"SQUALL_BACKEND", "omp"}, {"SQUALL_DEVICE", "0"}});
}

TEST(Usage, VariablesAreCheckedLikeOptions) {
  expect_usage_error({"run", k_tiny, "--backend", "reference"}, "--frames", {{"SQUALL_FRAMES", "0"}});
  expect_usage_error({"run", k_tiny}, "cuda", {{"SQUALL_BACKEND", "cuda"}});
  expect_usage_error({"run", k_tiny, "--backend", "reference"}, "not in this version", {{"SQUALL_TOLERANCE", "1"}});
}

TEST(Usage, VariablesOfOtherCommandsAreNoConcern) {
  EXPECT_EQ(squall({"devices"}, {{"SQUALL_FRAMES", "0"}}).code, 0);
  // A list is fine for compare; run takes one.
  EXPECT_EQ(squall({"compare", k_tiny, "--backend", "reference", "--frames", "1"}, {{"SQUALL_THREADS", "1,2"}}).code,
            0);
  EXPECT_EQ(squall({"compare", k_tiny, "--backend", "reference", "--frames", "1"}, {{"SQUALL_RESTART", "c"}}).code, 0);
  expect_usage_error({"run", k_tiny, "--frames", "1"}, "--threads", {{"SQUALL_THREADS", "1,2"}});
}

}  // namespace
}  // namespace squall::app
