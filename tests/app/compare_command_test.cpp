#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

std::vector<std::string> labels(const json& result) {
  std::vector<std::string> names;
  for (const auto& run : result.at("runs")) names.push_back(run.at("label"));
  return names;
}

TEST(DevicesCommand, ListsEveryBackend) {
  const Outcome table = squall({"devices"});
  EXPECT_EQ(table.code, 0) << table.err;
  for (const char* backend : {"reference", "omp", "opencl"})
    EXPECT_NE(table.out.find(backend), std::string::npos) << table.out;
  const json result = json::parse(squall({"devices", "--json", "-"}).out);
  ASSERT_EQ(result["backends"].size(), 3u);
  EXPECT_EQ(result["backends"][0]["name"], "reference");
  EXPECT_EQ(result["backends"][0]["devices"].size(), 1u);
}

TEST(DevicesCommand, SaysWhyOpenClCannotRun) {
  const Outcome outcome =
      squall({"devices", "--json", "-"}, {{"OCL_ICD_VENDORS", "/no/such/folder"}, {"OCL_ICD_FILENAMES", ""}});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const json opencl = json::parse(outcome.out).at("backends").at(2);
  EXPECT_EQ(opencl["name"], "opencl");
  EXPECT_NE(opencl["problem"], "");
}

TEST(CompareCommand, TheReferenceRunsOnlyWhenNamedAndNeverAgrees) {
  const Outcome outcome = squall({"compare", k_tiny, "--backend", "reference", "--frames", "4", "--json", "-"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_THAT(labels(result), testing::ElementsAre("reference, double"));
  EXPECT_EQ(result["runs"][0]["frames"], 4);
  EXPECT_TRUE(result["agreement"]["bitwise"].is_null());
  EXPECT_FALSE(result["runs"][0].contains("position_error_dx"));
}

TEST(CompareCommand, DfsphAgreesBitByBitOnOmpAndOpenCl) {
  const Outcome outcome =
      squall({"compare", k_tiny, "--pressure", "dfsph", "--readback", "none,mapped", "--frames", "4", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  const std::vector<std::string> names = labels(result);
  EXPECT_THAT(names, testing::IsSupersetOf({"omp, 1 thread", "opencl 0, none", "opencl 0, mapped"}));
  EXPECT_EQ(result["agreement"]["bitwise"], true);
  for (const json& run : result["runs"]) {
    EXPECT_GE(run["density_iterations"]["mean"], 2.0);
    EXPECT_EQ(run["density_iterations"], result["runs"][0]["density_iterations"]);
    EXPECT_EQ(run["light_pass_ns"].is_null(), run["backend"] == "opencl") << "which does not time them";
    for (const char* phase : {"prepare", "divergence solve", "predict", "density solve", "drift"})
      EXPECT_TRUE(run["phase_ms"].contains(phase)) << phase << " in " << run["phase_ms"];
  }
}

TEST(CompareCommand, ThreadCountsAgreeBitByBit) {
  const TemporaryFolder folder;
  const Outcome outcome = squall({"compare", k_tiny, "--backend", "reference", "--backend", "omp", "--threads", "1,2,3",
                                  "--frames", "10", "--json", "-", "--out", folder / "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_THAT(labels(result),
              testing::ElementsAre("reference, double", "omp, 1 thread", "omp, 2 threads", "omp, 3 threads"));
  EXPECT_EQ(result["agreement"]["bitwise"], true);
  EXPECT_EQ(result["agreement"]["max_position_error_dx"], 0.0);
  EXPECT_EQ(result["runs"][1]["state_hash"], result["runs"][3]["state_hash"]);
  EXPECT_GT(result["runs"][1]["position_error_dx"], 0.0) << "single precision cannot hit double exactly";
  EXPECT_EQ(result["runs"][1]["readback_mode"], "in_place");
  const std::string frames = text_of(folder / "out/frames.csv");
  EXPECT_EQ(std::count(frames.begin(), frames.end(), '\n'), 1 + 4 * 10);
}

// Double precision is the reference's to the last bit, on every backend and in every read-back mode.
TEST(CompareCommand, InDoublePrecisionAllHitTheReference) {
  const Outcome outcome = squall({"compare", k_tiny, "--precision", "double", "--backend", "reference", "--backend",
                                  "omp", "--backend", "opencl", "--frames", "6", "--threads", "2", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["agreement"]["bitwise"], true);
  EXPECT_EQ(result["agreement"]["verdict"], "same bits in 7 double-precision runs after each of 11 frames");
  ASSERT_EQ(result["runs"].size(), 8u);
  for (const auto& run : result["runs"]) {
    EXPECT_EQ(run["precision"], "double") << run["label"];
    EXPECT_EQ(run["position_error_dx"], 0.0) << run["label"];
    EXPECT_EQ(run["state_hash"], result["runs"][0]["state_hash"]) << run["label"];
    EXPECT_FALSE(run.contains("error")) << run["label"];
  }
  EXPECT_EQ(result["runs"][1]["label"], "omp, 2 threads, double");
}

TEST(CompareCommand, AThreadCountAskedForTwiceRunsOnce) {
  const Outcome outcome =
      squall({"compare", k_tiny, "--backend", "omp", "--threads", "2,1,2,1", "--frames", "2", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(labels(json::parse(outcome.out)), testing::ElementsAre("omp, 2 threads", "omp, 1 thread"));
}

TEST(CompareCommand, EveryReadBackModeOfADeviceTakesPart) {
  const Outcome outcome =
      squall({"compare", k_tiny, "--backend", "opencl", "--device", "0", "--frames", "6", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_THAT(labels(result), testing::ElementsAre("opencl 0, none", "opencl 0, blocking", "opencl 0, pinned",
                                                   "opencl 0, mapped", "opencl 0, async", "opencl 0, quantized"));
  EXPECT_EQ(result["agreement"]["bitwise"], true);
  EXPECT_FALSE(result["runs"][0].contains("exposed_readback_ms"));
  EXPECT_FALSE(result["runs"][0].contains("readback_overlap")) << "there is no copy to hide";
  EXPECT_EQ(result["runs"][4]["readback_latency_frames"], 1);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_GT(result["runs"][i]["readback_bytes_per_frame"], 0);
    EXPECT_GE(result["runs"][i]["readback_copy_ms"], 0);
    EXPECT_LE(result["runs"][i].value("readback_overlap", 0.0), 1.0);
    EXPECT_TRUE(result["runs"][i]["exposed_readback_ms"].is_number());
    EXPECT_LE(result["runs"][i]["exposed_readback_interval_ms"]["low"], result["runs"][i]["exposed_readback_ms"]);
  }
  EXPECT_FALSE(result["context"]["opencl"].is_null());
}

TEST(CompareCommand, TheDefaultIsEveryBackendAndAllAgree) {
  const Outcome outcome = squall({"compare", k_tiny, "--frames", "20"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* text : {"omp, 1 thread", "opencl 0, none", "opencl 0, pinned", "agreement: same bits"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << outcome.out;
}

TEST(CompareCommand, ADeviceAskedForThatIsNotThereEndsIt) {
  const Environment no_opencl{{"OCL_ICD_VENDORS", "/no/such/folder"}, {"OCL_ICD_FILENAMES", ""}};
  EXPECT_EQ(squall({"compare", k_tiny, "--backend", "opencl", "--frames", "1"}, no_opencl).code, 4);
  EXPECT_EQ(squall({"compare", k_tiny, "--device", "0", "--frames", "1"}, no_opencl).code, 4);
  EXPECT_EQ(squall({"compare", k_tiny, "--device", "no such name", "--frames", "1"}).code, 4);
  const Outcome without = squall({"compare", k_tiny, "--threads", "1,2", "--frames", "2"}, no_opencl);
  EXPECT_EQ(without.code, 0) << without.err;
  EXPECT_NE(without.err.find("opencl is left out"), std::string::npos) << without.err;
}

}  // namespace
}  // namespace squall::app
