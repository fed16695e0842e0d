#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

const std::vector<std::string> k_study{"study",  k_tiny, "--pressure", "wcsph", "--backend",   "omp", "--threads", "1",
                                       "--vary", "step", "--frames",   "6",     "--perturbed", "1",   "--repeats", "1"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// A command line without spaces inside its words; the first is the program.
std::vector<std::string> words_of(const std::string& command) {
  std::istringstream text(command);
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  words.erase(words.begin());
  return words;
}

TEST(StudyCommand, EveryPointIsRunAgainByItsCommand) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(with(k_study, {"--out", folder / "out", "--max-error", "10"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(text_of(folder / "out/study.json"));
  ASSERT_EQ(result["points"].size(), 3u);
  for (const auto& point : result["points"]) {
    const Outcome again = squall(with(words_of(point["command"]), {"--json", "-"}));
    ASSERT_EQ(again.code, 0) << point["command"] << again.err;
    const json row = json::parse(again.out)["runs"][0];
    for (const char* same : {"state_hash", "steps", "threads", "precision", "pressure", "simulated_s"})
      EXPECT_EQ(row[same], point[same]) << same << " of " << point["name"];
  }
  const json reference = result["models"][0]["reference"];
  const Outcome again = squall(with(words_of(reference["command"]), {"--json", "-"}));
  ASSERT_EQ(again.code, 0) << reference["command"] << again.err;
  EXPECT_EQ(json::parse(again.out)["runs"][0]["state_hash"], reference["state_hash"]);
}

// No scene lies beside it then: of three steps one is the scene's own.
TEST(StudyCommand, WithoutAFolderACommandSaysWhatItLacks) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(with(k_study, {"--json", folder / "study.json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  int alone = 0;
  const json result = json::parse(text_of(folder / "study.json"));
  ASSERT_EQ(result["points"].size(), 3u);
  for (const auto& point : result["points"]) {
    const std::string command = point["command"];
    if (command.find("  # but with [solver] cfl = ") != std::string::npos) continue;
    ++alone;
    const Outcome again = squall(with(words_of(command), {"--json", "-"}));
    ASSERT_EQ(again.code, 0) << command << again.err;
    EXPECT_EQ(json::parse(again.out)["runs"][0]["state_hash"], point["state_hash"]) << command;
  }
  EXPECT_EQ(alone, 1);
}

TEST(StudyCommand, WritesTablesPlotsAndOnePage) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(with(k_study, {"--out", folder / "out", "--budget-ms", "1e6"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* text : {"wcsph, step x2", "wall s/s", "yardstick", "most accurate within", "horizon", "squall run"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text << "\n" << outcome.out;
  EXPECT_EQ(lines_in(text_of(folder / "out/study.csv")), 4u);
  for (const char* plot : {"work_precision.svg", "step_error.svg", "separation.svg"})
    EXPECT_NE(text_of(folder / "out/" + plot).find("</svg>"), std::string::npos) << plot;
  const std::string page = text_of(folder / "out/report.html");
  EXPECT_NE(page.find("</html>"), std::string::npos);
  for (const char* way : {"http:", "https:", " src=", "<script", "<link", "@import"})
    EXPECT_EQ(page.find(way), std::string::npos) << way;
}

TEST(StudyCommand, AnotherQuestionNeedsNoRunAgain) {
  const TemporaryFolder folder;
  const auto arguments = with(k_study, {"--out", folder / "out", "--json", "-"});
  const Outcome first = squall(arguments);
  ASSERT_EQ(first.code, 0) << first.err;
  const std::string runs = text_of(folder / "out/runs.jsonl");
  const Outcome second = squall(with(arguments, {"--error", "y_cm_m", "--max-error", "1e-30"}));
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(text_of(folder / "out/runs.jsonl"), runs);
  json before = json::parse(first.out), after = json::parse(second.out);
  EXPECT_EQ(after["measured"]["runs_from_before"], lines_in(runs));
  for (auto* result : {&before, &after})
    for (auto& point : (*result)["points"]) point.erase("pareto");  // of another error
  EXPECT_EQ(before["points"], after["points"]);
  EXPECT_TRUE(after["recommendation"]["cheapest_within_max_error"].is_null());
}

TEST(StudyCommand, AnInterruptKeepsWhatRanAndTheNextStartGoesOn) {
  const TemporaryFolder folder;
  // Ten million frames are not over before the interrupt.
  Program program({"study", k_tiny, "--pressure", "wcsph", "--backend", "omp", "--threads", "1", "--vary", "step",
                   "--frames", "10000000", "--out", folder / "out"});
  // The interrupt is caught from before this file appears.
  for (int tries = 0; tries < 3000 && !std::filesystem::exists(folder / "out/runs.jsonl"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.interrupt();
  const Outcome cut = program.wait();
  EXPECT_EQ(cut.code, 130) << cut.err;
  EXPECT_EQ(json::parse(text_of(folder / "out/study.json"))["interrupted"], true);
  EXPECT_NE(text_of(folder / "out/report.html").find("</html>"), std::string::npos);

  ASSERT_EQ(squall(with(k_study, {"--out", folder / "out"})).code, 0);
  const std::string runs = text_of(folder / "out/runs.jsonl");
  // A process that is killed while it writes leaves half a line.
  const std::size_t second_line = runs.find('\n') + 1;
  std::ofstream(folder / "out/runs.jsonl") << runs.substr(0, second_line + 100);
  const Outcome resumed = squall(with(k_study, {"--out", folder / "out", "--json", "-"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(json::parse(resumed.out)["measured"]["runs_from_before"], 1);
  EXPECT_EQ(lines_in(text_of(folder / "out/runs.jsonl")), lines_in(runs));
}

TEST(StudyCommand, ABudgetThatNothingKeepsIsExitSeven) {
  const Outcome outcome = squall(with(k_study, {"--budget-ms", "1e-6", "--json", "-"}));
  EXPECT_EQ(outcome.code, 7) << outcome.err;
  EXPECT_TRUE(json::parse(outcome.out)["recommendation"]["best_within_budget"].is_null());
}

/// The folder's files, each with what it holds.
std::map<std::string, std::string> files_in(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[entry.path().string()] = text_of(entry.path().string());
  return files;
}

/// A scene with this beside the box of k_dry.
const std::string k_dry =
    "schema = 1\n[time]\nduration_s = 1.0\n[fluid]\nspacing_m = 0.1\n[container]\nmin_m = [0, 0, 0]\n"
    "max_m = [1, 9, 1]\nopen_top = true\n";

TEST(StudyCommand, ASceneWithoutWaterIsRefusedBeforeAnythingIsMade) {
  const TemporaryFolder folder;
  std::ofstream(folder / "dry.toml") << k_dry;
  std::ofstream(folder / "late.toml") << k_dry
                                      << "[[rain]]\nparticles_per_s = 60\ndrop_diameter_mm = 2\narea_min_m = [0, 0]\n"
                                         "area_max_m = [1, 1]\nheight_m = 9\nstart_s = 0.5\nmax_particles = 9\n";
  for (const char* scene : {"dry.toml", "late.toml"}) {
    const Outcome outcome =
        squall({"study", folder / scene, "--backend", "omp", "--seconds", "0.3", "--out", folder / "out"});
    EXPECT_EQ(outcome.code, 3) << outcome.out;
    EXPECT_NE(outcome.err.find("x_cm_m, y_cm_m, front_m"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

TEST(StudyCommand, WithoutASingleErrorItDoesNotEndWell) {
  const TemporaryFolder folder;
  std::ofstream(folder / "high.toml") << k_dry << "[[block]]\nmin_m = [0, 8, 0]\nmax_m = [0.3, 8.3, 0.3]\n";
  std::vector<std::string> arguments = k_study;
  arguments[1] = folder / "high.toml";
  const Outcome combined = squall(arguments);
  EXPECT_EQ(combined.code, 0) << combined.err;
  EXPECT_NE(combined.err.find("the combined error is of x_cm_m, y_cm_m, energy_j here"), std::string::npos)
      << combined.err;
  const Outcome front = squall(with(arguments, {"--error", "front_m", "--out", folder / "out"}));
  EXPECT_EQ(front.code, 3) << front.out;
  EXPECT_NE(front.err.find("front_m has no value at any output time"), std::string::npos) << front.err;
  EXPECT_NE(front.out.find("no value"), std::string::npos) << front.out;
  EXPECT_NE(front.out.find("no setting has both a time and the front_m error"), std::string::npos) << front.out;
  EXPECT_NE(text_of(folder / "out/report.html").find("no front_m error"), std::string::npos);
}

TEST(StudyCommand, AFolderOfAnotherSceneIsLeftAlone) {
  const TemporaryFolder folder;
  const auto here = with(k_study, {"--out", folder / "out"});
  ASSERT_EQ(squall(here).code, 0);
  const auto before = files_in(folder / "out");
  const std::string scene = text_of(k_tiny);
  std::ofstream(folder / "other.toml") << scene << "\n[gravity]\nvector_m_s2 = [0, -5, 0]\n";
  auto other = here;
  other[1] = folder / "other.toml";
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = squall(arguments);
    EXPECT_EQ(outcome.code, 3) << outcome.out;
    for (const std::string& text : {folder / "out", std::string("scene tiny"), std::string("name another --out")})
      EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  };
  refused(other);
  refused(with(here, {"--particles", "300"}));
  refused({"sweep", k_tiny, "--backend", "omp", "--particles", "70", "--frames", "2", "--out", folder / "out"});
  refused({"validate", "free_fall", "--quick", "--out", folder / "out"});
  EXPECT_EQ(files_in(folder / "out"), before);
  std::filesystem::remove(folder / "out/study.json");  // killed before its end, which only its runs tell
  refused(other);
  refused({"sweep", k_tiny, "--backend", "omp", "--particles", "70", "--frames", "2", "--out", folder / "out"});
  std::filesystem::copy(k_tiny, folder / "copy.toml");  // the same water under another name
  auto copy = here;
  copy[1] = folder / "copy.toml";
  const Outcome resumed = squall(with(copy, {"--json", "-"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(json::parse(resumed.out)["measured"]["runs_from_before"], lines_in(text_of(folder / "out/runs.jsonl")));
}

TEST(StudyCommand, WhatCannotBeStudiedIsRefused) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--vary", "colour"},
                                                                                    {"--error", "beauty"},
                                                                                    {"--effort", "some"},
                                                                                    {"--max-error", "0"},
                                                                                    {"--perturbed", "-1"},
                                                                                    {"--repeats", "0"},
                                                                                    {"--fast-math"},
                                                                                    {"--trace", "x"}})
    EXPECT_EQ(squall(with({"study", k_tiny, "--frames", "1"}, more)).code, 2) << more.front();
  EXPECT_EQ(squall({"study", folder / "none.toml"}).code, 3);
  std::filesystem::create_directories(folder / "out");
  std::ofstream(folder / "out/runs.jsonl") << "no study\n";
  const Outcome other = squall(with(k_study, {"--out", folder / "out"}));
  EXPECT_EQ(other.code, 3);
  EXPECT_NE(other.err.find("runs.jsonl:1"), std::string::npos) << other.err;
  EXPECT_EQ(text_of(folder / "out/runs.jsonl"), "no study\n");
}

}  // namespace
}  // namespace squall::app
