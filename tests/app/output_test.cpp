#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

const std::vector<std::string> k_run{"run", k_tiny, "--backend", "reference", "--frames", "1"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> run_scene(const std::string& scene, const std::vector<std::string>& more) {
  return with({"run", scene, "--backend", "reference", "--frames", "1"}, more);
}

TEST(Output, AStdoutThatTakesNothingIsAnError) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           k_run, with(k_run, {"--json", "-"}), with(k_run, {"--print-scene"}), {"devices"}, {"--help"}})
    for (const char* place : {"/dev/full", Program::k_closed}) {
      const Outcome outcome = Program(arguments, {}, place).wait();
      EXPECT_EQ(outcome.code, 3) << arguments.back() << " to " << place;
      EXPECT_NE(outcome.err.find("stdout"), std::string::npos) << outcome.err;
    }
}

TEST(Output, AClosedStdoutIsNoFileOfOurs) {
  const TemporaryFolder folder;
  Program(with(k_run, {"--out", folder / "out", "--json", folder / "run.json"}), {}, Program::k_closed).wait();
  EXPECT_EQ(text_of(folder / "out/frames.csv").find("ms per frame"), std::string::npos);
  EXPECT_EQ(json::parse(text_of(folder / "run.json"))["runs"].size(), 1u);
}

TEST(Output, TheSceneIsNeverOverwritten) {
  const TemporaryFolder folder;
  const std::string text = text_of(k_tiny);
  std::ofstream(folder / "scene.toml") << text;
  std::filesystem::create_symlink(folder / "scene.toml", folder / "link.toml");
  const auto refused = [&](const std::string& scene, const std::vector<std::string>& target) {
    const Outcome outcome = squall(run_scene(scene, target));
    EXPECT_EQ(outcome.code, 2) << target.back() << outcome.err;
    EXPECT_NE(outcome.err.find("would overwrite"), std::string::npos) << outcome.err;
    EXPECT_EQ(text_of(folder / "scene.toml"), text);
  };
  refused(folder / "scene.toml", {"--out", folder / ""});
  refused(folder / "link.toml", {"--out", folder / "."});
  refused(folder / "scene.toml", {"--json", folder / "scene.toml"});
  refused(folder / "scene.toml", {"--json", folder / "link.toml"});
  const Outcome compared =
      squall({"compare", folder / "scene.toml", "--backend", "reference", "--frames", "1", "--out", folder / ""});
  EXPECT_EQ(compared.code, 2);
  EXPECT_EQ(text_of(folder / "scene.toml"), text);
}

TEST(Output, ParticleFilesAreNeverOverwritten) {
  const TemporaryFolder folder;
  const std::string particles = "x,y,z,vx,vy,vz\n0.1,0.1,0.1,0,0,0\n";
  std::filesystem::create_directory(folder / "out");
  std::ofstream(folder / "out/frame_000000.csv") << particles;
  std::string scene = text_of(k_tiny);
  scene.erase(scene.find("[[block]]"), scene.find("[[rain]]") - scene.find("[[block]]"));
  std::ofstream(folder / "again.toml") << scene << "\n[[particles]]\nfile = \"out/frame_000000.csv\"\n";
  for (const std::vector<std::string>& target :
       std::vector<std::vector<std::string>>{{"--out", folder / "out"}, {"--json", folder / "out/frame_000000.csv"}}) {
    const Outcome outcome = squall(run_scene(folder / "again.toml", target));
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("frame_000000.csv"), std::string::npos) << outcome.err;
    EXPECT_EQ(text_of(folder / "out/frame_000000.csv"), particles);
  }
}

TEST(Output, TwoOptionsNeverWriteOneFile) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run",          k_tiny, "--frames", "1",      "--quiet",
                                       "--save-every", "1",    "--out",    out + "/"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = squall(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("name the same file"), std::string::npos) << outcome.err;
  };
  // Whether the file is there or not, and however it is written.
  for (int round = 0; round < 2; ++round) {
    refused({"--json", folder / "a", "--trace", folder / "./a"});
    refused({"--json", folder / "out/frames.csv"});
    refused({"--trace", folder / "out/../out/gauges.csv"});
    refused({"--checkpoint", folder / "out/frame_000000.csv"});
    refused({"--json", folder / "out/frame_000007.csv"});
    ASSERT_EQ(squall({"run", k_tiny, "--frames", "1", "--quiet", "--out", out, "--json", folder / "a"}).code, 0);
  }
  std::filesystem::create_hard_link(folder / "a", folder / "b");
  refused({"--json", folder / "a", "--trace", folder / "b"});
  EXPECT_EQ(squall({"run", k_tiny, "--frames", "1", "--quiet", "--out", out, "--json", out + "/mine.json"}).code, 0);
}

TEST(Output, PlacesThatCannotBeWrittenAreFoundBeforeTheFirstFrame) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "mine";
  for (const std::vector<std::string>& target : std::vector<std::vector<std::string>>{
           {"--json", folder / "no/run.json"}, {"--json", folder / ""}, {"--out", folder / "file/out"}})
    for (const char* command : {"run", "compare"}) {
      // A run of ten million frames would not come back.
      const Outcome outcome = squall(with({command, k_tiny, "--backend", "reference", "--frames", "10000000"}, target));
      EXPECT_EQ(outcome.code, 3) << outcome.err;
      EXPECT_EQ(outcome.out, "");
    }
  EXPECT_EQ(text_of(folder / "file"), "mine");
}

TEST(Output, NothingOfAnEarlierRunStaysInTheFolder) {
  const TemporaryFolder folder;
  std::ofstream(folder / "notes.txt") << "mine";
  std::ofstream(folder / "frame_of_mine.csv") << "mine";
  ASSERT_EQ(squall(with(k_run, {"--save-every", "1", "--out", folder / ""})).code, 0);
  ASSERT_FALSE(text_of(folder / "frame_000000.csv").empty());
  ASSERT_EQ(
      squall({"compare", k_tiny, "--backend", "reference", "--frames", "1", "--out", folder / "", "--quiet"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "frame_000000.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "series.csv"));
  EXPECT_FALSE(text_of(folder / "frames.csv").empty());
  EXPECT_EQ(text_of(folder / "notes.txt"), "mine");
  EXPECT_EQ(text_of(folder / "frame_of_mine.csv"), "mine");
}

TEST(Output, ASceneNameNeedNotBeUtf8) {
  const TemporaryFolder folder;
  const std::string scene = folder / "\xff\xfe.toml";
  std::ofstream(scene) << text_of(k_tiny);
  const Outcome outcome = squall(run_scene(scene, {"--json", "-"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["runs"].size(), 1u);
}

}  // namespace
}  // namespace squall::app
