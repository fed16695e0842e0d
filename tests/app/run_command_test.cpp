#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.h"
#include "core/scene.h"

namespace squall::app {
namespace {

using nlohmann::json;

std::vector<std::string> reference_run(std::vector<std::string> more) {
  std::vector<std::string> arguments{"run", k_tiny, "--backend", "reference"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

json run_of(const Outcome& outcome) { return json::parse(outcome.out).at("runs").at(0); }

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(RunCommand, PrintsATableOnStdoutAndNotesOnStderr) {
  const Outcome outcome = squall(reference_run({"--frames", "3"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("ms per frame"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << "no colours where stdout is no terminal";
  EXPECT_NE(outcome.err.find("times 100 mm/h"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\r'), std::string::npos) << "no bar where stderr is no terminal";
  EXPECT_EQ(squall(reference_run({"--frames", "1", "--quiet"})).err, "");
}

TEST(RunCommand, JsonOnStdoutIsAlone) {
  const Outcome outcome = squall(reference_run({"--frames", "3", "--json", "-"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["scene"]["name"], "tiny");
  EXPECT_TRUE(result["agreement"].is_null());
  EXPECT_EQ(result["runs"][0]["backend"], "reference");
  EXPECT_EQ(result["runs"][0]["precision"], "double");
  EXPECT_EQ(result["runs"][0]["frames"], 3);
  EXPECT_EQ(result["runs"][0]["particles"], 56 + 4) << "two blocks of 48 and 8; two drops a frame, none at the start";
}

TEST(RunCommand, JsonInAFileLeavesTheTableOnStdout) {
  const TemporaryFolder folder;
  const Outcome outcome = squall(reference_run({"--frames", "2", "--json", folder / "run.json"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("ms per frame"), std::string::npos);
  EXPECT_EQ(json::parse(text_of(folder / "run.json"))["runs"][0]["frames"], 2);
  EXPECT_EQ(squall(reference_run({"--frames", "1", "--json", folder / "no/such/folder.json"})).code, 3);
}

TEST(RunCommand, GoogleBenchmarkShape) {
  const Outcome outcome = squall(reference_run({"--frames", "2", "--format", "google-benchmark"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["benchmarks"][0]["time_unit"], "ms");
}

TEST(RunCommand, LengthComesFromFramesOrSecondsOrTheScene) {
  const auto frames = [](std::vector<std::string> more, const Environment& environment = {}) {
    more.insert(more.end(), {"--json", "-", "--precision", "single"});
    return run_of(squall(reference_run(std::move(more)), environment)).at("frames").get<int>();
  };
  EXPECT_EQ(frames({}), 60);
  EXPECT_EQ(frames({"--seconds", "0.1"}), 6);
  EXPECT_EQ(frames({"--seconds", "0.101"}), 7);
  EXPECT_EQ(frames({}, {{"SQUALL_FRAMES", "4"}}), 4);
  EXPECT_EQ(frames({"--frames", "2"}, {{"SQUALL_FRAMES", "4"}}), 2) << "a flag wins over a variable";
  EXPECT_EQ(frames({"--seconds", "0.1"}, {{"SQUALL_FRAMES", "4"}}), 6);
}

TEST(RunCommand, TheSameRunGivesTheSameState) {
  const auto hash = [](std::vector<std::string> more) {
    more.insert(more.end(), {"--frames", "5", "--json", "-"});
    return run_of(squall(reference_run(std::move(more)))).at("state_hash").get<std::string>();
  };
  EXPECT_EQ(hash({}), hash({}));
  EXPECT_NE(hash({}), hash({"--seed", "2"}));
  EXPECT_NE(hash({}), hash({"--pressure", "mueller"}));
  EXPECT_NE(hash({}), hash({"--dt-max", "0.0005"}));
}

TEST(RunCommand, ParticlesChangeTheSpacingAndTheRealCountIsReported) {
  const json result = json::parse(squall(reference_run({"--particles", "300", "--frames", "1", "--json", "-"})).out);
  Scene scene = load_scene(k_tiny);
  scale_to_particles(scene, 300);
  EXPECT_EQ(result["scene"]["particles"], particle_capacity(scene));
  EXPECT_EQ(result["scene"]["hash"], scene_hash(scene));
}

TEST(RunCommand, WritesItsFolder) {
  const TemporaryFolder folder;
  const Outcome outcome =
      squall(reference_run({"--frames", "6", "--save-every", "2", "--pressure", "mueller", "--out", folder / "out"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(lines_in(text_of(folder / "out/frames.csv")), 1u + 6u);
  EXPECT_EQ(lines_in(text_of(folder / "out/series.csv")), 1u + 6u);
  const std::string saved = text_of(folder / "out/frame_000001.csv");
  EXPECT_EQ(saved.substr(0, saved.find('\n')), "id,x,y,z,vx,vy,vz");
  EXPECT_EQ(lines_in(saved), 1u + 58u) << "56 at the start, two drops in the second frame";
  EXPECT_FALSE(text_of(folder / "out/frame_000005.csv").empty());
  EXPECT_TRUE(text_of(folder / "out/frame_000002.csv").empty());

  const Scene stored = load_scene(folder / "out/scene.toml");
  EXPECT_EQ(stored.solver.pressure, Pressure::mueller);
  EXPECT_EQ(stored.blocks.size(), 2u);
}

TEST(RunCommand, TheStoredSceneRunsToTheSameState) {
  const TemporaryFolder folder;
  const Outcome first = squall(reference_run(
      {"--frames", "4", "--particles", "100", "--pressure", "mueller", "--out", folder / "out", "--json", "-"}));
  ASSERT_EQ(first.code, 0) << first.err;
  const Outcome second =
      squall({"run", folder / "out/scene.toml", "--backend", "reference", "--frames", "4", "--json", "-"});
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(run_of(first)["state_hash"], run_of(second)["state_hash"]);
}

TEST(RunCommand, PrintsTheSceneAsItWouldRun) {
  const Outcome outcome = squall({"run", k_tiny, "--print-scene", "--dt-max", "0.001"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(parse_scene(outcome.out, k_tiny).solver.dt_max_s, 0.001);
}

TEST(RunCommand, BadScenesAreTheCallersFault) {
  const Outcome missing = squall({"run", "no_such_scene.toml", "--backend", "reference"});
  EXPECT_EQ(missing.code, 3);
  EXPECT_EQ(missing.out, "");
  EXPECT_NE(missing.err.find("no_such_scene.toml"), std::string::npos);

  const TemporaryFolder folder;
  std::ofstream(folder / "bad.toml") << text_of(k_tiny) << "\n[fluids]\nspacing = 3\n";
  const Outcome bad = squall({"run", folder / "bad.toml", "--backend", "reference", "--json", "-"});
  EXPECT_EQ(bad.code, 3);
  EXPECT_EQ(bad.out, "");
  EXPECT_NE(bad.err.find("bad.toml:"), std::string::npos) << bad.err;
}

// Beyond 2.1 particles pair up, which a reader must know; beyond 2.2 dfsph's water flies apart, which nobody wants.
TEST(RunCommand, SupportRatiosThatHarmAreSaid) {
  const TemporaryFolder folder;
  std::string text = text_of(k_tiny);
  const auto run_at = [&](const std::string& ratio, const std::string& pressure) {
    std::string scene = text;
    scene.insert(scene.find("spacing_m"), "support_ratio = " + ratio + "\n");
    std::ofstream(folder / "scene.toml") << scene;
    return squall({"run", folder / "scene.toml", "--frames", "1", "--pressure", pressure, "--out", folder / "out"});
  };
  const std::string pairs = "lie in pairs";
  const Outcome refused = run_at("2.21", "dfsph");
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("support_ratio = 2.21 is too large for dfsph"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  for (const char* pressure : {"wcsph", "mueller", "dfsph"}) {
    EXPECT_NE(run_at("2.2", pressure).err.find(pairs), std::string::npos) << pressure;
    EXPECT_EQ(run_at("2.1", pressure).err.find(pairs), std::string::npos) << pressure;
  }
  EXPECT_EQ(run_at("4", "wcsph").code, 0);
}

// What makes every run of a scene explode is refused before it starts, as the command line has it.
TEST(RunCommand, StepsThatNoFrameHasRoomForAreRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "pitch.toml") << k_pitch;
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", folder / "pitch.toml", "--frames", "1", "--out", folder / "out"});
    return squall(more);
  };
  for (const char* pressure : {"dfsph", "wcsph", "mueller"}) {
    const Outcome refused = run({"--pressure", pressure});
    EXPECT_EQ(refused.code, 3) << pressure;
    EXPECT_NE(refused.err.find("pitch.toml: viscosity_m2_s = 65 needs"), std::string::npos) << refused.err;
    EXPECT_EQ(run({"--pressure", pressure, "--dt-max", "1e-4"}).code, 3) << "dt_max is not what binds";
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  const Outcome coarse = run({"--particles", "8"});
  EXPECT_EQ(coarse.code, 0) << "as the command line has it: " << coarse.err;
}

TEST(RunCommand, ADeviceIsNoScene) {
  const Outcome outcome = squall({"run", "/dev/zero"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("it is a device"), std::string::npos) << outcome.err;
}

TEST(RunCommand, ADeviceThatIsNotThereIsSaid) {
  const Outcome outcome = squall({"run", k_tiny, "--backend", "opencl", "--frames", "1"},
                                 {{"OCL_ICD_VENDORS", "/no/such/folder"}, {"OCL_ICD_FILENAMES", ""}});
  EXPECT_EQ(outcome.code, 4) << outcome.out;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("opencl"), std::string::npos) << outcome.err;
}

TEST(RunCommand, BudgetsAreKeptOrExceeded) {
  const Outcome exceeded = squall(reference_run({"--frames", "3", "--budget-ms", "0.0001"}));
  EXPECT_EQ(exceeded.code, 7) << exceeded.err;
  EXPECT_NE(exceeded.out.find("budget exceeded"), std::string::npos) << exceeded.out;
  EXPECT_EQ(squall(reference_run({"--frames", "3", "--budget-ms", "60000"})).code, 0);
}

TEST(RunCommand, AnUnstableRunIsAnErrorRow) {
  // At 1000 m/s water leaves the open container, and the room for coordinates around it, within the first frame.
  const TemporaryFolder folder;
  std::string scene = text_of(k_tiny);
  const std::string held = "held_until_s = 0.01";
  scene.replace(scene.find(held), held.size(), "velocity_m_s = [0.0, 1000.0, 0.0]");
  std::ofstream(folder / "fast.toml") << scene;
  const Outcome outcome =
      squall({"run", folder / "fast.toml", "--backend", "reference", "--frames", "2", "--json", "-"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_TRUE(run_of(outcome).contains("error")) << outcome.out;
  EXPECT_FALSE(run_of(outcome).contains("fps"));
}

/// Ends a long run by a signal once it is under way, and returns how it ended; everything it was asked for is there.
int code_after(void (Program::*signal)() const) {
  const TemporaryFolder folder;
  Program program(reference_run({"--frames", "1000000", "--json", folder / "run.json", "--out", folder / "out"}));
  // The interrupt is caught from before this file appears.
  for (int tries = 0; tries < 3000 && !std::filesystem::exists(folder / "out/frames.csv"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  (program.*signal)();
  const Outcome outcome = program.wait();
  const json run = json::parse(text_of(folder / "run.json")).at("runs").at(0);
  EXPECT_LT(run["frames"], 1000000);
  EXPECT_EQ(lines_in(text_of(folder / "out/frames.csv")), 1u + run["frames"].get<std::size_t>());
  return outcome.code;
}

TEST(RunCommand, AnInterruptFinishesTheFrameAndWritesWhatWasAsked) { EXPECT_EQ(code_after(&Program::interrupt), 130); }

TEST(RunCommand, SigtermDoesSoToo) { EXPECT_EQ(code_after(&Program::terminate), 143); }

TEST(RunCommand, SolvesThatEndAtTheirLimitAreSaidAndNoError) {
  const TemporaryFolder folder;
  std::string scene = text_of(k_tiny);
  scene.insert(scene.find("[fluid]"), "[solver]\nmax_iterations = 1\n\n");
  const std::string file = folder / "one.toml";
  std::ofstream(file) << scene;
  const std::string told = "pressure solves ended at max_iterations above their tolerance";
  const std::vector<std::string> rest{"--backend", "omp", "--threads", "1", "--frames", "20"};
  const auto run = [&](const std::string& command, const std::string& which, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{command, which};
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = squall(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome;
  };
  for (const char* command : {"run", "compare"}) {
    EXPECT_NE(run(command, file, {}).out.find("warning: "), std::string::npos) << command;
    EXPECT_NE(run(command, file, {}).out.find(told), std::string::npos) << command;
    const Outcome alone = run(command, file, {"--json", "-"});
    EXPECT_NE(alone.err.find(told), std::string::npos) << alone.err;
    EXPECT_GT(run_of(alone)["unconverged"], 10);
    EXPECT_LE(run_of(alone)["unconverged"], 2 * run_of(alone)["steps"].get<int>());
    EXPECT_GT(run_of(alone)["density_error_mean"], 1e-2) << "ten times the tolerance";
  }
  const Outcome sweep = run("sweep", file, {"--particles", "70", "--json", "-"});
  EXPECT_NE(sweep.err.find(told), std::string::npos) << sweep.err;
  EXPECT_NE(json::parse(sweep.out)["notes"].dump().find(told), std::string::npos);
  const Outcome enough = run("run", k_tiny, {"--json", "-"});
  EXPECT_EQ(run_of(enough)["unconverged"], 0);
  EXPECT_EQ(enough.err.find(told), std::string::npos);
}

TEST(RunCommand, WaterThatStaysTooDenseIsSaidThoughEverySolveConverged) {
  const TemporaryFolder folder;
  std::ofstream(folder / "crowd.csv") << "x,y,z,vx,vy,vz\n0.5,0.5,0.5,0,0,0\n0.501,0.5,0.5,0,0,0\n0.5,0.501,0.5,0,0,0\n"
                                         "0.5,0.5,0.501,0,0,0\n0.5,0.501,0.501,0,0,0\n0.501,0.501,0.501,0,0,0\n";
  const std::string file = folder / "crowd.toml";
  std::ofstream(file) << "schema = 1\n[time]\nduration_s = 1.0\n[fluid]\nspacing_m = 0.1\n[container]\n"
                         "min_m = [0, 0, 0]\nmax_m = [1, 1, 1]\n[[particles]]\nfile = \"crowd.csv\"\n";
  const std::string told = "where density_tolerance asks for 0.1 %";
  const auto run = [&](const std::string& pressure) {
    const Outcome outcome =
        squall({"run", file, "--pressure", pressure, "--backend", "omp", "--frames", "1", "--json", "-"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome;
  };
  const Outcome outcome = run("dfsph");
  EXPECT_EQ(run_of(outcome)["unconverged"], 0);
  EXPECT_GT(run_of(outcome)["density_error_worst"], 0.01);
  EXPECT_NE(outcome.err.find(told), std::string::npos) << outcome.err;
  EXPECT_EQ(run("wcsph").err.find(told), std::string::npos) << "which promises no density";
}

TEST(RunCommand, AForcedSolverThatCannotRunASceneMayBeReplaced) {
  const TemporaryFolder folder;
  std::string text = text_of(k_tiny);
  text.insert(text.find("spacing_m"), "support_ratio = 2.5\n");
  std::ofstream(folder / "far.toml") << text << "\n[solver]\npressure = \"dfsph\"\n";
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", folder / "far.toml", "--backend", "reference", "--frames", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return squall(arguments);
  };
  const Outcome forced = run({});
  EXPECT_EQ(forced.code, 3);
  EXPECT_NE(forced.err.find("far.toml:8:17: support_ratio = 2.5 is too large for dfsph"), std::string::npos)
      << forced.err;
  const Outcome replaced = run({"--pressure", "wcsph"});
  EXPECT_EQ(replaced.code, 0) << replaced.err;
  EXPECT_EQ(run({"--pressure", "dfsph"}).code, 3);
}

}  // namespace
}  // namespace squall::app
