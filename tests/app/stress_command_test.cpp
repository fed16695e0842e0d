#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

TEST(StressCommand, PrintsATableAndNoSurprise) {
  const Outcome outcome = squall({"stress", "--quick", "--case", "4,20,33", "--pressure", "wcsph"});
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  for (const char* text : {"1: omp, ", "2: opencl 0", " 4 one particle alone", "known: ", "0 unexpected"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text << "\n" << outcome.out;
}

TEST(StressCommand, JsonHoldsFindings) {
  const Outcome outcome = squall({"stress", "--quick", "--case", "4,30", "--backend", "omp", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["quick"], true);
  ASSERT_EQ(result["cases"].size(), 6u);
  for (const auto& tried : result["cases"]) {
    EXPECT_EQ(tried["backend"], "omp");
    if (tried["number"] == 4) {
      EXPECT_EQ(tried["verdict"], "passed");
      EXPECT_GE(tried["findings"].size(), 3u);
    }
    if (tried["number"] == 30 && tried["pressure"] != "dfsph") {
      EXPECT_EQ(tried["verdict"], "not_applicable");
    }
  }
}

TEST(StressCommand, LooksForTheLargestStep) {
  const TemporaryFolder folder;
  const Outcome outcome = squall({"stress", "--largest-step", "--quick", "--pressure", "wcsph", "--precision", "single",
                                  "--json", folder / "steps.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  EXPECT_NE(outcome.out.find("squall's own steps are stable; the least margin"), std::string::npos) << outcome.out;
  const json result = json::parse(text_of(folder / "steps.json"));
  EXPECT_EQ(result["interrupted"], false);
  ASSERT_EQ(result["largest_steps"].size(), 2u);
  for (const auto& row : result["largest_steps"]) {
    EXPECT_EQ(row["backend"], "omp");
    EXPECT_EQ(row["speed_of_sound_m_s"], 20.0);
    EXPECT_GT(row["largest_step_s"], row["taken_step_s"]);
    EXPECT_EQ(row["margin"].get<double>(), row["largest_step_s"].get<double>() / row["taken_step_s"].get<double>());
  }
  EXPECT_EQ(squall({"stress", "--largest-step", "--case", "4"}).code, 2);
}

TEST(StressCommand, AnInterruptKeepsTheStepsThatWereFound) {
  const TemporaryFolder folder;
  // Without OpenCL, whose compilers catch signals of their own.
  Program program({"stress", "--largest-step", "--backend", "reference", "--json", folder / "steps.json"},
                  {{"OCL_ICD_VENDORS", "/no/such/folder"}, {"OCL_ICD_FILENAMES", ""}});
  for (int tries = 0; tries < 3000 && !program.catches_interrupts(); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.interrupt();
  EXPECT_EQ(program.wait().code, 130);
  EXPECT_EQ(json::parse(text_of(folder / "steps.json"))["interrupted"], true);
}

TEST(StressCommand, RefusesWhatItCannotTry) {
  EXPECT_EQ(squall({"stress", "--case", "35"}).code, 2);
  EXPECT_EQ(squall({"stress", "--case", "x"}).code, 2);
  EXPECT_EQ(squall({"stress", "--pressure", "none"}).code, 2);
  EXPECT_EQ(squall({"stress", "scene.toml"}).code, 2);
  EXPECT_EQ(squall({"stress", "--case", "4", "--json", "/nowhere/x.json"}).code, 3);
}

}  // namespace
}  // namespace squall::app
