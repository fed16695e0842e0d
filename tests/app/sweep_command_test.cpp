#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

const std::vector<std::string> k_sweep{"sweep", k_tiny,     "--particles", "70,400",   "--threads",
                                       "1,2",   "--frames", "6",           "--device", "0"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// A strict XML reader takes the file.
bool is_well_formed(const std::string& file) {
  const std::string command = "python3 -c \"import sys, xml.dom.minidom as m; m.parse(sys.argv[1])\" '" + file + "'";
  return std::system(command.c_str()) == 0;
}

TEST(SweepCommand, WritesTablesPlotsAndOnePage) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(with(k_sweep, {"--budget-ms", "1e6", "--out", folder / "out"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* text :
       {"frames per second", "speed-up against omp with 1 thread", "times real time", "crossover: ", "omp, 2 threads",
        "opencl 0, mapped, 1 thread", "every size fits", "agreement: the same bits at 2 of 2"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text << "\n" << outcome.out;
  for (const char* plot : {"fps", "speedup", "frame_time", "realtime_factor"})
    EXPECT_TRUE(is_well_formed(folder / "out/" + plot + ".svg")) << plot;
  EXPECT_EQ(lines_in(text_of(folder / "out/points.csv")), 1u + 2u * 4u);
  EXPECT_EQ(json::parse(text_of(folder / "out/sweep.json"))["points"].size(), 8u);
  const std::string page = text_of(folder / "out/report.html");
  EXPECT_NE(page.find("</html>"), std::string::npos);
  for (const char* way : {"http:", "https:", " src=", "<script", "<link", "@import"})
    EXPECT_EQ(page.find(way), std::string::npos) << way;
}

TEST(SweepCommand, JsonHoldsEveryPoint) {
  const Outcome outcome = squall(with(k_sweep, {"--json", "-"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  for (const char* name : {"schema", "context", "scene", "measured", "points", "sizes", "crossover", "agreement"})
    EXPECT_TRUE(result.contains(name)) << name;
  EXPECT_TRUE(result["budget"].is_null());
  ASSERT_EQ(result["points"].size(), 8u);
  EXPECT_EQ(result["points"][0]["speedup"], 1.0);
  for (const auto& point : result["points"]) {
    EXPECT_EQ(point["frames"], 6);
    EXPECT_EQ(point["simulated_s"], result["points"][0]["simulated_s"]);
    EXPECT_GT(point["readback_share"], -1.0);
    EXPECT_EQ(point["readback_mode"], point["backend"] == "omp" ? "in_place" : "mapped") << "delivery is measured";
  }
  EXPECT_EQ(result["crossover"].size(), 2u);
  EXPECT_THAT(result["crossover"][0]["against"], testing::ElementsAre("omp, 1 thread"));
  EXPECT_EQ(result["agreement"]["bitwise"], true);
  EXPECT_EQ(result["sizes"].size(), 2u);
  EXPECT_LT(result["sizes"][0]["particles"], result["sizes"][1]["particles"]);
}

TEST(SweepCommand, ABudgetThatNothingKeepsIsExitSeven) {
  const Outcome outcome = squall({"sweep", k_tiny, "--backend", "omp", "--threads", "1", "--particles", "70",
                                  "--frames", "3", "--budget-ms", "1e-6", "--json", "-"});
  EXPECT_EQ(outcome.code, 7) << outcome.err;
  const json budget = json::parse(outcome.out)["budget"];
  EXPECT_EQ(budget["runs"][0]["fit"], "none");
  EXPECT_TRUE(budget["runs"][0]["largest"].is_null());
}

TEST(SweepCommand, WithoutGnuplotItEndsBeforeAnythingIsMeasured) {
  const TemporaryFolder folder;
  const Environment nowhere{{"PATH", folder / ""}};
  // A run of ten million frames would not come back.
  const Outcome outcome = squall(
      {"sweep", k_tiny, "--backend", "omp", "--particles", "70", "--frames", "10000000", "--out", folder / "out"},
      nowhere);
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("gnuplot"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  const Outcome without = squall({"sweep", k_tiny, "--backend", "omp", "--particles", "70", "--frames", "2"}, nowhere);
  EXPECT_EQ(without.code, 0) << without.err;
}

TEST(SweepCommand, AnInterruptKeepsWhatWasMeasured) {
  const TemporaryFolder folder;
  Program program({"sweep", k_tiny, "--backend", "omp", "--threads", "1", "--particles", "70,400", "--frames",
                   "1000000", "--out", folder / "out", "--json", folder / "sweep.json"});
  // The interrupt is caught from before this file appears.
  for (int tries = 0; tries < 3000 && !std::filesystem::exists(folder / "out/points.csv"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.interrupt();
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  const json result = json::parse(text_of(folder / "sweep.json"));
  EXPECT_EQ(result["interrupted"], true);
  ASSERT_EQ(result["points"].size(), 1u);
  EXPECT_EQ(result["points"][0]["interrupted"], true);
  EXPECT_NE(text_of(folder / "out/report.html").find("</html>"), std::string::npos);
}

TEST(SweepCommand, WhatCannotBeSweptIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "points.csv") << "x,y,z,vx,vy,vz\n0.1,0.1,0.1,0,0,0\n";
  std::string scene = text_of(k_tiny);
  scene.erase(scene.find("[[block]]"), scene.find("[[rain]]") - scene.find("[[block]]"));
  std::ofstream(folder / "file.toml") << scene << "\n[[particles]]\nfile = \"points.csv\"\n";
  const Outcome unscalable = squall({"sweep", folder / "file.toml", "--backend", "omp", "--particles", "70"});
  EXPECT_EQ(unscalable.code, 3) << unscalable.err;
  EXPECT_NE(unscalable.err.find("cannot be scaled"), std::string::npos) << unscalable.err;
  const Outcome overwriting = squall({"sweep", folder / "file.toml", "--backend", "omp", "--out", folder / ""});
  EXPECT_NE(overwriting.code, 0);
  EXPECT_NE(text_of(folder / "points.csv").find("0.1,0.1"), std::string::npos);
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--particles", "0"}, {"--particles", "70,many"}, {"--format", "squall"}, {"--save-every", "2"}})
    EXPECT_EQ(squall(with({"sweep", k_tiny, "--frames", "1"}, more)).code, 2) << more.front();
}

// A size whose time steps are too short to be taken is refused when it comes; what came before stays.
TEST(SweepCommand, SizesThatNoFrameHasRoomForEndIt) {
  const TemporaryFolder folder;
  std::ofstream(folder / "pitch.toml") << k_pitch;
  const auto sweep = [&](const std::string& sizes) {
    return squall({"sweep", folder / "pitch.toml", "--backend", "omp", "--threads", "1", "--frames", "1", "--particles",
                   sizes, "--json", folder / "sweep.json"});
  };
  const Outcome second = sweep("8,64");
  EXPECT_EQ(second.code, 3) << second.err;
  EXPECT_NE(second.err.find("ended before 64 particles: viscosity_m2_s = 65 needs"), std::string::npos) << second.err;
  EXPECT_EQ(json::parse(text_of(folder / "sweep.json"))["points"].size(), 1u);
  EXPECT_EQ(sweep("64").code, 3);
}

TEST(SweepCommand, AFolderOfAnotherSceneIsLeftAlone) {
  const TemporaryFolder folder;
  const auto sweep = [&](const std::string& scene, const std::string& sizes) {
    return squall({"sweep", scene, "--backend", "omp", "--threads", "1", "--particles", sizes, "--frames", "2", "--out",
                   folder / "out"});
  };
  ASSERT_EQ(sweep(k_tiny, "70").code, 0);
  const std::string before = text_of(folder / "out/sweep.json"), page = text_of(folder / "out/report.html");
  std::ofstream(folder / "other.toml") << text_of(k_tiny) << "\n[gravity]\nvector_m_s2 = [0, -5, 0]\n";
  const Outcome other = sweep(folder / "other.toml", "70");
  EXPECT_EQ(other.code, 3);
  EXPECT_NE(other.err.find("holds what `squall sweep` found of scene tiny"), std::string::npos) << other.err;
  EXPECT_EQ(text_of(folder / "out/sweep.json"), before);
  EXPECT_EQ(text_of(folder / "out/report.html"), page);
  EXPECT_EQ(sweep(k_tiny, "70,400").code, 0) << "one's own sweep is replaced";
  EXPECT_EQ(json::parse(text_of(folder / "out/sweep.json"))["points"].size(), 2u);
}

TEST(SweepCommand, ADeviceAskedForThatIsNotThereEndsIt) {
  const Environment no_opencl{{"OCL_ICD_VENDORS", "/no/such/folder"}, {"OCL_ICD_FILENAMES", ""}};
  EXPECT_EQ(squall({"sweep", k_tiny, "--backend", "opencl", "--particles", "70"}, no_opencl).code, 4);
  const Outcome without = squall({"sweep", k_tiny, "--particles", "70", "--threads", "1", "--frames", "2"}, no_opencl);
  EXPECT_EQ(without.code, 0) << without.err;
  EXPECT_NE(without.err.find("opencl is left out"), std::string::npos) << without.err;
}

}  // namespace
}  // namespace squall::app
