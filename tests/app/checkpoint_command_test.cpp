// --checkpoint, --checkpoint-every and --restart of the command: killed, interrupted, on another backend, on a full
// disk.
#include "core/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.h"
#include "core/checkpoint_file.h"
#include "core/state_hash.h"

namespace squall::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int k_frames = 8;

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> run_on(const std::string& backend, const std::vector<std::string>& more) {
  return with({"run", k_tiny, "--quiet", "--json", "-", "--backend", backend}, more);
}

/// In single precision, as the other backends compute: the same bits.
std::vector<std::string> reference_run(const std::vector<std::string>& more) {
  return with(run_on("reference", {"--precision", "single"}), more);
}

json row_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.code == 0 ? json::parse(outcome.out).at("runs").at(0) : json::object();
}

/// The state after so many frames of a run that nothing disturbs.
std::string undisturbed_hash(int frames) {
  return row_of(squall(reference_run({"--frames", std::to_string(frames)}))).value("state_hash", "");
}

std::string hash_of(const Checkpoint& checkpoint) {
  return hash_text(state_hash(checkpoint.state.particles, checkpoint.precision));
}

bool appears(const std::function<bool()>& condition) {
  for (int tries = 0; tries < 3000 && !condition(); ++tries) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(CheckpointCommand, RunThenRestartIsOneRun) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  ASSERT_EQ(squall(reference_run({"--frames", "5", "--checkpoint", file})).code, 0);
  const Checkpoint saved = read_checkpoint(file);
  EXPECT_EQ(saved.state.clock.frame, 5u);
  EXPECT_EQ(hash_of(saved), undisturbed_hash(5));
  const json row = row_of(squall(reference_run({"--frames", "3", "--restart", file})));
  EXPECT_EQ(row["state_hash"], undisturbed_hash(k_frames));
  EXPECT_EQ(row["frames"], 3);
  EXPECT_EQ(row["start_frame"], 5);
  EXPECT_EQ(std::filesystem::exists(file + ".part"), false);
}

TEST(CheckpointCommand, EveryBackendGoesOnFromEveryOther) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  const std::string expected = undisturbed_hash(k_frames);
  const std::vector<std::vector<std::string>> backends{
      {"omp", "--threads", "2"}, {"opencl", "--readback", "async"}, {"reference", "--precision", "single"}};
  for (const auto& first : backends)
    for (const auto& second : backends) {
      if (first == second) continue;
      const auto run = [&](const std::vector<std::string>& backend, const std::vector<std::string>& more) {
        return squall(with(with({"run", k_tiny, "--quiet", "--json", "-", "--backend"}, backend), more));
      };
      ASSERT_EQ(run(first, {"--frames", "5", "--checkpoint", file}).code, 0);
      EXPECT_EQ(row_of(run(second, {"--frames", "3", "--restart", file}))["state_hash"], expected)
          << first[0] << " to " << second[0];
    }
}

TEST(CheckpointCommand, DoublePrecisionGoesOnToo) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  const auto run = [&](const std::vector<std::string>& more) {
    return squall(with({"run", k_tiny, "--json", "-", "--backend", "reference"}, more));
  };
  const json straight = row_of(run({"--frames", "8", "--pressure", "dfsph"}));
  ASSERT_EQ(run({"--frames", "5", "--pressure", "dfsph", "--checkpoint", file}).code, 0);
  const json resumed = row_of(run({"--frames", "3", "--pressure", "dfsph", "--restart", file}));
  EXPECT_EQ(resumed["state_hash"], straight["state_hash"]);
  EXPECT_EQ(resumed["energy_drift"], straight["energy_drift"]) << "measured from the start of the water";
  const Outcome single = run({"--frames", "3", "--pressure", "dfsph", "--precision", "single", "--restart", file});
  EXPECT_EQ(single.code, 0);
  EXPECT_THAT(single.err, HasSubstr("goes on in single: not to the same bits"));
}

TEST(CheckpointCommand, RestartGoesOnToTheEndOfTheScene) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  ASSERT_EQ(squall(reference_run({"--frames", "55", "--checkpoint", file})).code, 0);
  EXPECT_EQ(row_of(squall(reference_run({"--restart", file, "--checkpoint", file})))["frames"], 5);
  const Outcome done = squall(reference_run({"--restart", file}));
  EXPECT_EQ(done.code, 3);
  EXPECT_THAT(done.err, HasSubstr("nothing is left to do: it has 60 frames"));
}

// Rows of the frames before the checkpoint stay, those after it come again: as if nothing had happened.
TEST(CheckpointCommand, TheFolderOfResultsGoesOn) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  const std::vector<std::string> save{"--save-every", "2", "--out"};
  ASSERT_EQ(squall(with(reference_run({"--frames", "8"}), with(save, {folder / "straight"}))).code, 0);
  ASSERT_EQ(squall(reference_run({"--frames", "3", "--checkpoint", file})).code, 0);
  ASSERT_EQ(squall(with(reference_run({"--frames", "7"}), with(save, {folder / "parts"}))).code, 0);
  // Killed while it wrote frame 7.
  std::ofstream(folder / "parts/series.csv", std::ios::app) << "0.13";
  ASSERT_EQ(squall(with(reference_run({"--frames", "5", "--restart", file}), with(save, {folder / "parts"}))).code, 0);
  EXPECT_EQ(text_of(folder / "parts/series.csv"), text_of(folder / "straight/series.csv"));
  for (const char* name : {"/frame_000001.csv", "/frame_000003.csv", "/frame_000005.csv", "/frame_000007.csv"})
    EXPECT_EQ(text_of(folder / ("parts" + std::string(name))), text_of(folder / ("straight" + std::string(name))));
  // Rows of frames that are to come again do not outlive a run that makes none.
  const auto rows = [&](const std::string& name) {
    const std::string text = text_of(folder / name);
    return std::count(text.begin(), text.end(), '\n') - 1;
  };
  std::filesystem::copy(folder / "straight", folder / "again");
  EXPECT_EQ(
      squall(reference_run({"--frames", "1", "--restart", file, "--out", folder / "again", "--checkpoint", "/proc/x"}))
          .code,
      3);
  EXPECT_EQ(rows("again/series.csv"), 3);
  EXPECT_EQ(rows("again/frames.csv"), 3);
  EXPECT_EQ(rows("parts/frames.csv"), 8);

  const Outcome foreign =
      squall(with(reference_run({"--frames", "1", "--restart", file, "--out"}), {folder / "other"}));
  EXPECT_EQ(foreign.code, 0) << "an empty folder is fine" << foreign.err;
  std::ofstream(folder / "other/scene.toml") << text_of(SQUALL_SCENES_DIR "/still.toml");
  EXPECT_THAT(squall(reference_run({"--frames", "1", "--restart", file, "--out", folder / "other"})).err,
              HasSubstr("results of another scene"));
}

constexpr const char* k_level = "[[gauge]]\nname = 'level'\nposition_m = [0.1, 0, 0.1]\nkind = 'level'\n";

/// A scene of the folder: the tiny one with what is added.
std::string scene_with(const TemporaryFolder& folder, const std::string& name, const std::string& gauges) {
  std::ofstream(folder / name) << text_of(k_tiny) << gauges;
  return folder / name;
}

std::vector<std::string> gauge_run(const std::string& scene, const std::vector<std::string>& more) {
  return with({"run", scene, "--quiet", "--backend", "reference", "--precision", "single"}, more);
}

TEST(CheckpointCommand, GaugesGoOnAsIfNothingHadHappened) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc", scene = scene_with(folder, "gauges.toml", k_level);
  ASSERT_EQ(squall(gauge_run(scene, {"--frames", "8", "--out", folder / "straight"})).code, 0);
  ASSERT_EQ(squall(gauge_run(scene, {"--frames", "3", "--out", folder / "parts", "--checkpoint", file})).code, 0);
  ASSERT_EQ(squall(gauge_run(scene, {"--frames", "5", "--out", folder / "parts", "--restart", file})).code, 0);
  EXPECT_EQ(text_of(folder / "parts/gauges.csv"), text_of(folder / "straight/gauges.csv"));
}

// A checkpoint promises the rows up to it, those of gauges too: they are not in a buffer that dies with the process.
TEST(CheckpointCommand, RowsOfGaugesAreWrittenBeforeTheirCheckpoint) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc", scene = scene_with(folder, "gauges.toml", k_level);
  const Program program(gauge_run(
      scene, {"--frames", "10000000", "--out", folder / "out", "--checkpoint", file, "--checkpoint-every", "0.05"}));
  const bool saved = appears([&] { return std::filesystem::exists(file); });
  program.kill_now();
  ASSERT_TRUE(saved);
  const std::uint64_t frames = read_checkpoint(file).state.clock.frame;
  const std::string text = text_of(folder / "out/gauges.csv");
  EXPECT_GE(static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n')), frames + 1);  // and the header
}

// What cannot go on is refused before anything of it is cut off.
TEST(CheckpointCommand, AFolderWithOtherGaugesIsLeftAlone) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc", scene = scene_with(folder, "gauges.toml", k_level);
  ASSERT_EQ(squall(gauge_run(scene, {"--frames", "2", "--checkpoint", file})).code, 0);
  ASSERT_EQ(squall(gauge_run(scene, {"--frames", "5", "--out", folder / "out"})).code, 0);
  const std::string rows = text_of(folder / "out/series.csv"), saved_scene = text_of(folder / "out/scene.toml");
  const std::string other = std::string(k_level).replace(std::string(k_level).find("level"), 5, "depth");
  for (const std::string& gauges : {std::string(), other, k_level + other}) {
    const std::string with_others = scene_with(folder, "others.toml", gauges);
    const Outcome outcome =
        squall(gauge_run(with_others, {"--frames", "1", "--out", folder / "out", "--restart", file}));
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("are not those of this scene's gauges"));
    EXPECT_EQ(text_of(folder / "out/series.csv"), rows);
    EXPECT_EQ(text_of(folder / "out/scene.toml"), saved_scene);
  }
}

TEST(CheckpointCommand, ALinkKeepsPointingAtTheCheckpoint) {
  const TemporaryFolder folder;
  ASSERT_EQ(squall(reference_run({"--frames", "1", "--checkpoint", folder / "real.sqc"})).code, 0);
  std::filesystem::create_symlink(folder / "real.sqc", folder / "link.sqc");
  ASSERT_EQ(squall(reference_run({"--frames", "2", "--checkpoint", folder / "link.sqc"})).code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.sqc"));
  EXPECT_EQ(read_checkpoint(folder / "real.sqc").state.clock.frame, 2u);
}

// A device would never end, a pipe without a writer never begin.
TEST(CheckpointCommand, RowsThatAreNoFileAreRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc", scene = scene_with(folder, "gauges.toml", k_level);
  ASSERT_EQ(squall(gauge_run(scene, {"--frames", "2", "--checkpoint", file, "--out", folder / "out"})).code, 0);
  for (const char* name : {"out/gauges.csv", "out/series.csv"}) {
    std::filesystem::rename(folder / name, folder / "rows");
    std::filesystem::create_symlink("/dev/full", folder / name);
    const Outcome outcome = squall(gauge_run(scene, {"--frames", "1", "--restart", file, "--out", folder / "out"}));
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("it is no file"));
    std::filesystem::rename(folder / "rows", folder / name);
  }
}

TEST(CheckpointCommand, OtherRunsAreRefusedByName) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  ASSERT_EQ(squall(reference_run({"--frames", "2", "--seed", "5", "--checkpoint", file})).code, 0);
  const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
    const Outcome outcome = squall(with(reference_run({"--frames", "1", "--restart", file}), more));
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refused({}, "add --seed 5");
  refused({"--seed", "5", "--pressure", "mueller"}, "add --pressure dfsph");
  refused({"--seed", "5", "--dt-max", "0.001"}, "[solver] dt_max_s is 0.005 there and 0.001 here");
  refused({"--seed", "5", "--particles", "500"}, "[fluid] spacing_m is 0.05 there");
  std::filesystem::resize_file(file, 100);
  refused({"--seed", "5"}, "is cut off: it has 100 of ");
  std::ofstream(file) << "not a checkpoint, but a text as long as the beginning of one";
  refused({}, "is no squall checkpoint");
  std::filesystem::remove(file);
  refused({}, "No such file");
}

TEST(CheckpointCommand, ItsOptionsAreChecked) {
  const TemporaryFolder folder;
  const auto usage = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const Outcome outcome = squall(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  usage(reference_run({"--checkpoint-every", "1"}), "add --checkpoint FILE");
  usage(reference_run({"--checkpoint", folder / "c", "--checkpoint-every", "0"}), "--checkpoint-every: '0'");
  usage(reference_run({"--checkpoint", "-"}), "take files");
  usage(reference_run({"--checkpoint", k_tiny}), "would overwrite");
  usage(with({"run", k_tiny, "--json", folder / "c"}, {"--checkpoint", folder / "c"}), "name the same file");
  usage(reference_run({"--out", folder / "out", "--checkpoint", folder / "out/series.csv"}), "name the same file");
  usage({"run", k_tiny, "--json", folder / "c.part", "--checkpoint", folder / "c"}, "FILE.part name the same file");
  std::ofstream(folder / "c") << "mine";
  usage({"run", k_tiny, "--json", folder / "c", "--restart", folder / "c"}, "would overwrite");
  EXPECT_EQ(text_of(folder / "c"), "mine");
  for (const char* command : {"compare", "sweep"})
    usage({command, k_tiny, "--restart", folder / "c"},
          "--restart of " + std::string(command) + " is not in this version");
}

TEST(CheckpointCommand, PlacesThatTakeNoCheckpointAreFoundBeforeTheFirstFrame) {
  const TemporaryFolder folder;
  for (const std::string& place : {folder / "no/run.sqc", folder / "", std::string("/proc/run.sqc")}) {
    // A run of ten million frames would not come back.
    const Outcome outcome = squall(reference_run({"--frames", "10000000", "--checkpoint", place}));
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(CheckpointCommand, AFullDiskIsFoundBeforeTheFirstFrame) {
  const TemporaryFolder folder;
  Program program(reference_run({"--frames", "10000000", "--checkpoint", folder / "run.sqc"}), {}, "", 2000);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("cannot claim"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run.sqc.part"));
}

// A folder in its place takes no file, whoever asks. The run goes on, and what it gave is written all the same.
TEST(CheckpointCommand, ACheckpointThatCannotBeWrittenDoesNotEndTheRun) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  Program program({"run", k_tiny, "--backend", "reference", "--frames", "1000000", "--checkpoint", file,
                   "--checkpoint-every", "0.02", "--json", folder / "run.json"});
  ASSERT_TRUE(appears([&] { return std::filesystem::exists(file); }));
  std::error_code error;
  // The run may just have put back what was removed.
  ASSERT_TRUE(appears([&] {
    std::filesystem::remove(file, error);
    return std::filesystem::create_directory(file, error);
  }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  program.interrupt();
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.code, 3) << "the last one could not be written either";
  EXPECT_THAT(outcome.err, HasSubstr("the run goes on and tries again"));
  const auto first = outcome.err.find("cannot be"), last = outcome.err.rfind("the run goes on");
  EXPECT_LE(first, last);
  EXPECT_EQ(outcome.err.find("the run goes on"), last) << "said once, not every time";
  EXPECT_GT(json::parse(text_of(folder / "run.json")).at("runs").at(0).at("frames"), 0);
}

TEST(CheckpointCommand, AnInterruptSavesTheLastFrame) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  Program program(reference_run({"--frames", "1000000", "--checkpoint", file, "--out", folder / "out"}));
  ASSERT_TRUE(
      appears([&] { return !text_of(folder / "out/scene.toml").empty() && std::filesystem::exists(file + ".part"); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  program.interrupt();
  const Outcome outcome = program.wait();
  ASSERT_EQ(outcome.code, 130) << outcome.err;
  const json row = json::parse(outcome.out).at("runs").at(0);
  const Checkpoint saved = read_checkpoint(file);
  EXPECT_EQ(saved.state.clock.frame, row["frames"].get<std::uint64_t>());
  EXPECT_EQ(hash_of(saved), row["state_hash"]);
}

// Killed again and again, each run goes on from what the one before it saved last. The file is always whole, and the
// water that of a run that nobody killed.
TEST(CheckpointCommand, KilledAtAnyMomentTheLastCheckpointLoads) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  const std::vector<std::string> save{"--checkpoint", file, "--checkpoint-every", "0.01"};
  std::uint64_t frame = 0;
  for (int round = 0; round < 12; ++round) {
    const auto before =
        std::filesystem::exists(file) ? std::filesystem::last_write_time(file) : std::filesystem::file_time_type::min();
    auto arguments = with(reference_run({"--frames", "1000000"}), save);
    if (frame > 0) arguments = with(arguments, {"--restart", file});
    Program program(arguments);
    ASSERT_TRUE(
        appears([&] { return std::filesystem::exists(file) && std::filesystem::last_write_time(file) > before; }));
    std::this_thread::sleep_for(std::chrono::microseconds(731 * round));
    program.kill_now();
    ASSERT_EQ(program.wait().code, -SIGKILL);
    const Checkpoint saved = read_checkpoint(file);
    ASSERT_GT(saved.state.clock.frame, frame) << "each round gets further";
    frame = saved.state.clock.frame;
  }
  EXPECT_EQ(hash_of(read_checkpoint(file)), undisturbed_hash(static_cast<int>(frame)));
}

}  // namespace
}  // namespace squall::app
