#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

std::vector<std::string> tiny(const std::string& command, std::vector<std::string> more) {
  std::vector<std::string> arguments{command, k_tiny, "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Events of a process (its number from 1) by name.
std::map<std::string, std::vector<json>> events_of(const json& trace, int process) {
  std::map<std::string, std::vector<json>> events;
  for (const auto& event : trace["traceEvents"])
    if (event["pid"] == process) events[event["name"]].push_back(event);
  return events;
}

TEST(Trace, ARunOnOmp) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(tiny("run", {"--backend", "omp", "--pressure", "wcsph", "--frames", "3", "--trace",
                                              folder / "trace.json", "--json", folder / "run.json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json trace = json::parse(text_of(folder / "trace.json"));
  const json run = json::parse(text_of(folder / "run.json"))["runs"][0];
  EXPECT_EQ(run["traced"], true);
  EXPECT_EQ(trace["otherData"]["squall_version"],
            json::parse(text_of(folder / "run.json"))["context"]["squall_version"]);
  auto events = events_of(trace, 1);
  EXPECT_EQ(events["frame"].size(), 3u) << "counted frames only";
  EXPECT_EQ(events["sub-step"].size(), run["steps"]);
  EXPECT_EQ(events["density"].size(), run["steps"]);
  double phases = 0, frames = 0;
  for (const char* phase : {"sort", "density", "forces"})
    for (const auto& event : events[phase]) phases += event["dur"].get<double>();
  for (const auto& event : events["frame"]) frames += event["dur"].get<double>();
  EXPECT_GT(phases, 0.0);
  EXPECT_LE(phases, frames);
}

TEST(Trace, AComparisonHasAProcessPerRun) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(tiny(
      "compare", {"--frames", "2", "--threads", "1", "--readback", "none,blocking", "--trace", folder / "trace.json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json trace = json::parse(text_of(folder / "trace.json"));
  std::vector<std::string> processes;
  for (const auto& event : trace["traceEvents"])
    if (event["name"] == "process_name") processes.push_back(event["args"]["name"]);
  EXPECT_THAT(processes,
              testing::ElementsAre("omp, 1 thread", testing::HasSubstr("none"), testing::HasSubstr("blocking")));
  for (int process = 1; process <= 3; ++process) EXPECT_EQ(events_of(trace, process)["frame"].size(), 2u);
  EXPECT_FALSE(events_of(trace, 2).contains("stage_positions"));
  EXPECT_EQ(events_of(trace, 3)["stage_positions"].size(), events_of(trace, 3)["sub-step"].size());
}

TEST(Trace, TheReferenceHasFramesAndNoPhases) {
  const TemporaryFolder folder;
  ASSERT_EQ(squall(tiny("run", {"--backend", "reference", "--frames", "2", "--trace", folder / "trace.json"})).code, 0);
  const auto events = events_of(json::parse(text_of(folder / "trace.json")), 1);
  EXPECT_EQ(events.at("frame").size(), 2u);
  EXPECT_FALSE(events.contains("sub-step"));
}

TEST(Trace, ARowThatIsNotTracedDoesNotSaySo) {
  const Outcome outcome = squall(tiny("run", {"--backend", "reference", "--frames", "1", "--json", "-"}));
  EXPECT_FALSE(json::parse(outcome.out)["runs"][0].contains("traced"));
}

TEST(Trace, APlaceThatCannotBeWrittenIsFoundBeforeTheFirstFrame) {
  const TemporaryFolder folder;
  for (const char* command : {"run", "compare"})
    for (const std::string& place : {folder / "no/trace.json", folder / ""}) {
      // A run of ten million frames would not come back.
      const Outcome outcome =
          squall(tiny(command, {"--backend", "reference", "--frames", "10000000", "--trace", place}));
      EXPECT_EQ(outcome.code, 3) << outcome.err;
      EXPECT_NE(outcome.err.find("cannot write this file"), std::string::npos) << outcome.err;
    }
}

TEST(Trace, NeverOverTheSceneNorTheResult) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.toml") << text_of(k_tiny);
  const auto refused = [&](const std::vector<std::string>& more, const char* why) {
    std::vector<std::string> arguments{"run", folder / "scene.toml", "--backend", "reference", "--frames", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = squall(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  };
  refused({"--trace", folder / "scene.toml"}, "would overwrite");
  refused({"--trace", folder / "a.json", "--json", folder / "./a.json"}, "same file");
  refused({"--trace", "-"}, "writes to a file");
  EXPECT_EQ(text_of(folder / "scene.toml"), text_of(k_tiny));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
}

TEST(Trace, AnInterruptedRunLeavesWhatItHas) {
  const TemporaryFolder folder;
  Program program(tiny("run", {"--backend", "reference", "--frames", "10000000", "--out", folder / "out", "--trace",
                               folder / "trace.json"}));
  // This file appears with the first frame.
  for (int tries = 0; tries < 3000 && !std::filesystem::exists(folder / "out/series.csv"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.interrupt();
  EXPECT_EQ(program.wait().code, 130);
  EXPECT_GE(events_of(json::parse(text_of(folder / "trace.json")), 1)["frame"].size(), 1u);
}

}  // namespace
}  // namespace squall::app
