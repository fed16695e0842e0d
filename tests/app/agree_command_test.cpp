#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::vector<std::string> labels(const json& result) {
  std::vector<std::string> names;
  for (const auto& run : result.at("runs")) names.push_back(run.at("label"));
  return names;
}

void expect_all_the_same(const json& result) {
  EXPECT_EQ(result["agreement"]["agree"], true);
  for (const json& run : result["runs"]) {
    ASSERT_FALSE(run.contains("error")) << run;
    for (const char* level : {"integers", "one_step", "bits", "long_run", "run_to_run", "restart", "hand_over"})
      EXPECT_EQ(run[level], "same") << run["label"] << ", " << level << ": " << run["notes"];
    EXPECT_EQ(run["single_steps"].size(), 3u);
  }
  for (const json& pair : result["pairs"]) {
    EXPECT_EQ(pair["bitwise"], true) << pair;
    EXPECT_EQ(pair["bits_promised"], true) << pair;
  }
}

// Whatever this machine has: thread counts, instruction sets, and the OpenCL devices with each shape of kernels.
TEST(AgreeCommand, EveryPairHereIsTheSameWater) {
  for (const char* pressure : {"wcsph", "dfsph"}) {
    SCOPED_TRACE(pressure);
    const Outcome outcome = squall({"agree", k_tiny, "--pressure", pressure, "--frames", "6", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
    const json result = json::parse(outcome.out);
    EXPECT_THAT(labels(result),
                testing::IsSupersetOf({"reference, single", "omp, 1 thread", "omp, 3 threads, scalar",
                                       "opencl 0, particles", "opencl 0, float8", "opencl 0, float16"}));
    expect_all_the_same(result);
    const std::size_t runs = result["runs"].size();
    EXPECT_EQ(result["pairs"].size(), runs * (runs - 1) / 2);
    EXPECT_EQ(result["double_precision"]["growth"]["rms_dx"].size(), 6u);
  }
}

TEST(AgreeCommand, PrintsABlockToPaste) {
  const TemporaryFolder folder;
  const Outcome outcome = squall({"agree", k_tiny, "--backend", "omp", "--threads", "2", "--simd", "scalar", "--frames",
                                  "4", "--json", folder / "agree.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"squall agree: tiny", "squall 0.", "cpu: ", "omp: ", "promises bits", "reference, single",
                           "omp, 2 threads, scalar", "single from double precision", "pairs: 1 of 1 bitwise",
                           "AGREE: same bits in 2 of 2 runs after each of 4 frames"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << "plain text";
  const json result = json::parse(text_of(folder / "agree.json"));
  EXPECT_EQ(result["settings"]["frames"], 4);
  EXPECT_THAT(labels(result), testing::ElementsAre("reference, single", "omp, 2 threads, scalar"));
}

TEST(AgreeCommand, LargeScenesAreScaledUnlessTheSizeIsAskedFor) {
  const std::string collapse = SQUALL_SCENES_DIR "/collapse.toml";
  const std::vector<std::string> short_run{"agree",  collapse, "--backend", "omp", "--threads", "2",
                                           "--simd", "scalar", "--frames",  "1",   "--json",    "-"};
  const Outcome scaled = squall(short_run);
  ASSERT_EQ(scaled.code, 0) << scaled.err;
  EXPECT_THAT(scaled.err, HasSubstr("instead of 11664"));
  EXPECT_LE(json::parse(scaled.out)["scene"]["particles"], 3000);
  std::vector<std::string> sized = short_run;
  sized.insert(sized.end(), {"--particles", "200"});
  const json result = json::parse(squall(sized).out);
  EXPECT_LT(result["scene"]["particles"], 400);
}

TEST(AgreeCommand, RefusesWhatItCannotDo) {
  EXPECT_EQ(squall({"agree"}).code, 2);
  EXPECT_EQ(squall({"agree", k_tiny, "--frames", "0"}).code, 2);
  EXPECT_EQ(squall({"agree", k_tiny, "--simd", "avx3"}).code, 2);
  EXPECT_EQ(squall({"agree", k_tiny, "--backend", "reference", "--simd", "avx2"}).code, 2);
  EXPECT_EQ(squall({"agree", "/no/such/scene.toml"}).code, 3);
  EXPECT_EQ(squall({"agree", k_tiny, "--json", "/no/such/folder/file"}).code, 3);
  EXPECT_EQ(squall({"agree", k_tiny, "--json", k_tiny}).code, 2) << "the scene itself";
  EXPECT_EQ(squall({"agree", k_tiny, "--device", "no such device"}).code, 4);
  const Outcome alone = squall({"agree", k_tiny, "--backend", "reference"});
  EXPECT_EQ(alone.code, 2);
  EXPECT_EQ(alone.out, "");
  EXPECT_THAT(alone.err, HasSubstr("reference alone leaves nothing to compare"));
  EXPECT_THAT(alone.err, HasSubstr("omp or opencl"));
}

}  // namespace
}  // namespace squall::app
