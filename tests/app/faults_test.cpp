// What the command does when the machine fails it. Calls fail by a library that is preloaded (tests/faults/faults.cpp):
// what runs otherwise is the program as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.h"
#include "core/checkpoint_file.h"
#include "core/state_hash.h"

namespace squall::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// "FUNCTION CODE CALL": from its CALL-th call on, FUNCTION returns CODE.
Environment fault(const std::string& text) {
  // A sanitizer's runtime would insist on being the first library.
  return {{"LD_PRELOAD", SQUALL_FAULTS}, {"SQUALL_FAULT", text}, {"ASAN_OPTIONS", "verify_asan_link_order=0"}};
}

std::vector<std::string> run_on(const std::string& backend, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"run", k_tiny, "--quiet", "--backend", backend};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string hash_after(int frames) {
  const Outcome outcome =
      squall(run_on("reference", {"--precision", "single", "--frames", std::to_string(frames), "--json", "-"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return json::parse(outcome.out).at("runs").at(0).at("state_hash");
}

struct LateFault {
  std::string fault, code;
};
void PrintTo(const LateFault& fault, std::ostream* out) { *out << fault.fault; }

class InMidRun : public testing::TestWithParam<LateFault> {};

// Exit 4 and the cause; every frame until then in the results; the last of them saved, and good to go on from.
TEST_P(InMidRun, ADeviceThatFailsLeavesWhatWasComputed) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.sqc";
  const Outcome outcome = squall(run_on("opencl", {"--frames", "1000000", "--out", folder / "out", "--json",
                                                   folder / "run.json", "--checkpoint", file}),
                                 fault(GetParam().fault));
  ASSERT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(GetParam().code));
  const json row = json::parse(text_of(folder / "run.json")).at("runs").at(0);
  EXPECT_THAT(row.at("error").get<std::string>(), HasSubstr(GetParam().code));
  const std::string series = text_of(folder / "out/series.csv");
  const auto frames = std::count(series.begin(), series.end(), '\n') - 1;
  ASSERT_GT(frames, 0);
  const Checkpoint saved = read_checkpoint(file);
  EXPECT_EQ(saved.state.clock.frame, static_cast<std::uint64_t>(frames));
  EXPECT_EQ(hash_text(state_hash(saved.state.particles, saved.precision)), hash_after(static_cast<int>(frames)));
  const Outcome resumed = squall(run_on("omp", {"--frames", "2", "--restart", file, "--json", "-"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(json::parse(resumed.out).at("runs").at(0).at("state_hash"), hash_after(static_cast<int>(frames) + 2));
}
// A device that is lost, one without memory for a kernel or a table, one that fails while it computes or delivers.
INSTANTIATE_TEST_SUITE_P(
    Faults, InMidRun,
    testing::Values(LateFault{"clEnqueueNDRangeKernel -5 3000", "CL_OUT_OF_RESOURCES (-5)"},
                    LateFault{"clEnqueueNDRangeKernel -4 3333", "CL_MEM_OBJECT_ALLOCATION_FAILURE (-4)"},
                    LateFault{"clEnqueueWriteBuffer -6 40", "CL_OUT_OF_HOST_MEMORY (-6)"},
                    LateFault{"clEnqueueReadBuffer -5 60", "CL_OUT_OF_RESOURCES (-5)"},
                    LateFault{"clWaitForEvents -14 30", "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST (-14)"},
                    LateFault{"clFinish -36 40", "CL_INVALID_COMMAND_QUEUE (-36)"}));

TEST(Faults, ADeviceThatFailsIsARowBesideTheOthers) {
  const Outcome outcome = squall(
      {"compare", k_tiny, "--threads", "1", "--readback", "none,mapped", "--frames", "9", "--json", "-", "--quiet"},
      fault("clEnqueueNDRangeKernel -5 300"));
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  const json result = json::parse(outcome.out);
  int failed = 0;
  for (const json& row : result["runs"]) {
    failed += row.contains("error");
    if (row["backend"] == "omp") {
      EXPECT_EQ(row["frames"], 9) << row;
    }
  }
  EXPECT_GT(failed, 0);
}

// At the start nothing is computed yet: exit 4, the cause on stderr, nothing on stdout.
TEST(Faults, ADeviceThatFailsAtTheStartIsSaid) {
  const auto fails = [](const std::string& what, const std::string& why) {
    const Outcome outcome = squall(run_on("opencl", {"--frames", "2"}), fault(what));
    EXPECT_EQ(outcome.code, 4) << what << outcome.out;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(why)) << what;
  };
  fails("clBuildProgram -11 1", "the kernels do not build on");
  fails("clBuildProgram -6 1", "CL_OUT_OF_HOST_MEMORY (-6)");
  fails("clCreateBuffer -4 3", "CL_MEM_OBJECT_ALLOCATION_FAILURE (-4)");
  fails("clEnqueueNDRangeKernel -5 1", "CL_OUT_OF_RESOURCES (-5)");
  fails("clGetDeviceIDs -1 1", "no OpenCL driver offers a device");
  fails("clGetDeviceIDs -6 1", "CL_OUT_OF_HOST_MEMORY (-6)");
}

// dfsph keeps the weights of pairs where the device has room for them; what it gives does not depend on that.
TEST(Faults, ADeviceWithoutRoomForWeightsComputesThemAgain) {
  const auto run = [](const Environment& environment) {
    const Outcome outcome = squall({"run", SQUALL_SCENES_DIR "/collapse.toml", "--particles", "3000", "--frames", "2",
                                    "--quiet", "--backend", "opencl", "--json", "-"},
                                   environment);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  const json with = run({}), without = run(fault("clGetDeviceInfo 1000000 1"));
  EXPECT_EQ(with.at("runs").at(0).at("state_hash"), without.at("runs").at(0).at("state_hash"));
  EXPECT_THAT(with.dump(), HasSubstr("-DSQUALL_WEIGHTS=1"));
  EXPECT_THAT(without.dump(), HasSubstr("-DSQUALL_WEIGHTS=0"));
}

// At the start, while it warms up and in its first frame: what an earlier run left in the folder stays.
TEST(Faults, ADeviceThatFailsBeforeItsFirstFrameLeavesEarlierResults) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(squall(run_on("omp", {"--frames", "3", "--save-every", "1", "--out", out})).code, 0);
  const std::vector<std::string> names{"scene.toml", "frames.csv", "series.csv", "frame_000002.csv"};
  std::vector<std::string> earlier;
  for (const auto& name : names) earlier.push_back(text_of(out + "/" + name));
  for (const char* call : {"1", "5", "30", "60"}) {
    const Outcome failed = squall(run_on("opencl", {"--frames", "2", "--out", out}),
                                  fault(std::string("clEnqueueNDRangeKernel -5 ") + call));
    EXPECT_EQ(failed.code, 4) << "at call " << call;
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(text_of(out + "/" + names[i]), earlier[i]) << names[i];
  }
  ASSERT_EQ(squall(run_on("opencl", {"--frames", "1", "--out", out})).code, 0);
  EXPECT_NE(text_of(out + "/frames.csv"), earlier[1]);
  EXPECT_FALSE(std::filesystem::exists(out + "/frame_000002.csv"));
}

std::vector<std::string> texts_of(const std::string& folder) {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    texts.push_back(entry.path().filename().string() + ": " + text_of(entry.path().string()));
  std::sort(texts.begin(), texts.end());
  return texts;
}

/// A device that fails while it is set up, at the start or in the first frame costs nothing that is in `out`, and
/// leaves nothing else there; results that are new replace it.
void expect_earlier_results_stay(std::vector<std::string> arguments, const std::string& out) {
  arguments.insert(arguments.end(), {"--quiet", "--out", out, "--backend"});
  const auto on = [&](const char* backend, const Environment& environment = {}) {
    auto all = arguments;
    all.emplace_back(backend);
    return squall(all, environment);
  };
  ASSERT_EQ(on("omp").code, 0);
  const auto earlier = texts_of(out);
  ASSERT_GT(earlier.size(), 2u);
  for (const char* what : {"clCreateBuffer -4 3", "clEnqueueNDRangeKernel -5 1", "clEnqueueNDRangeKernel -5 5"}) {
    EXPECT_EQ(on("opencl", fault(what)).code, 4) << what;
    EXPECT_EQ(texts_of(out), earlier) << what;
  }
  const Outcome again = on("opencl");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_NE(texts_of(out), earlier);
}

TEST(Faults, ASweepThatFailsAtOnceLeavesEarlierResults) {
  const TemporaryFolder folder;
  expect_earlier_results_stay({"sweep", k_tiny, "--particles", "70", "--frames", "2", "--threads", "1"},
                              folder / "out");
}

TEST(Faults, AValidationThatFailsAtOnceLeavesEarlierResults) {
  const TemporaryFolder folder;
  std::ofstream(folder / "table.csv") << "time_s,x_cm_m\n0,0.1\n0.1,0.1\n";
  expect_earlier_results_stay(
      {"validate", k_tiny, "--expected", folder / "table.csv", "--tolerance", "10", "--pressure", "wcsph"},
      folder / "out");
}

// With nothing to lose, what there is to say of a failure is written.
TEST(Faults, ASweepThatFailsInAnEmptyFolderSaysSoThere) {
  const TemporaryFolder folder;
  const Outcome outcome = squall({"sweep", k_tiny, "--particles", "70", "--frames", "2", "--backend", "opencl",
                                  "--quiet", "--out", folder / "out"},
                                 fault("clEnqueueNDRangeKernel -5 5"));
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(text_of(folder / "out/sweep.json"), HasSubstr("CL_OUT_OF_RESOURCES"));
}

TEST(Faults, APlatformWithoutDevicesIsLeftOutWithAReason) {
  const Outcome devices = squall({"devices"}, fault("clGetDeviceIDs -1 1"));
  EXPECT_EQ(devices.code, 0) << devices.err;
  EXPECT_THAT(devices.out, HasSubstr("no OpenCL driver offers a device"));
  const Outcome compared =
      squall({"compare", k_tiny, "--threads", "1,2", "--frames", "2"}, fault("clGetDeviceIDs -1 1"));
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_THAT(compared.err, HasSubstr("opencl is left out: no OpenCL driver offers a device"));
}

TEST(Faults, ADriverThatCannotKeepItsKernelsIsSaid) {
  const Environment no_cache{{"POCL_CACHE_DIR", "/proc/no_such_folder"}};
  const Outcome outcome = squall(run_on("opencl", {"--frames", "2"}), no_cache);
  EXPECT_EQ(outcome.code, 4) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("set POCL_CACHE_DIR to a folder that can be written"));
}

#ifndef SQUALL_SANITIZED  // sanitizers have their own realloc
TEST(Faults, OmpWithoutMemoryForItsListsIsADeviceFailure) {
  const Outcome outcome =
      squall(run_on("omp", {"--frames", "3", "--particles", "4000", "--threads", "2"}), fault("realloc 12 1"));
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("out of memory for neighbour lists"));
}
#endif

#ifndef SQUALL_SANITIZED  // sanitizers reserve address space beyond any limit
// Where ulimit -v leaves too little, OpenMP and OpenCL drivers would end the process in their own ways.
TEST(Faults, TooLittleAddressSpaceIsSaid) {
  constexpr rlim_t k_mebibyte = rlim_t{1} << 20;
  const auto limited = [](const std::vector<std::string>& arguments, rlim_t mebibytes) {
    return Program(arguments, {}, "", 0, mebibytes * k_mebibyte).wait();
  };
  const Outcome threads = limited(run_on("omp", {"--frames", "1", "--threads", "1000"}), 1000);
  EXPECT_EQ(threads.code, 4) << threads.err;
  EXPECT_THAT(threads.err, HasSubstr("a team of 1000 threads needs"));
  EXPECT_THAT(threads.err, HasSubstr("ulimit -v, or use fewer threads"));
  EXPECT_EQ(limited(run_on("omp", {"--frames", "1", "--threads", "2"}), 1000).code, 0);

  const Outcome driver = limited(run_on("opencl", {"--frames", "1"}), 300);
  EXPECT_EQ(driver.code, 4) << driver.err;
  EXPECT_THAT(driver.err, HasSubstr("an OpenCL driver needs"));
  const Outcome compared = limited({"compare", k_tiny, "--frames", "1"}, 300);
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_THAT(compared.err, HasSubstr("opencl is left out: an OpenCL driver needs"));
}
#endif

TEST(Faults, MoreThreadsThanCoresChangeNothing) {
  const std::string expected = hash_after(5);
  const auto hash = [](std::vector<std::string> more, const Environment& environment) {
    more.insert(more.end(), {"--frames", "5", "--json", "-"});
    const Outcome outcome = squall(run_on("omp", more), environment);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out).at("runs").at(0).at("state_hash").get<std::string>();
  };
  EXPECT_EQ(hash({}, {{"OMP_NUM_THREADS", "64"}}), expected);
  EXPECT_EQ(hash({"--threads", "64"}, {}), expected);
  EXPECT_EQ(hash({"--threads", "2"}, {{"OMP_THREAD_LIMIT", "1"}}), expected);
  EXPECT_EQ(hash({"--threads", "2"}, {{"OMP_DYNAMIC", "true"}}), expected);
}

// Barriers that only spun would hardly get on beside others who keep every core busy.
TEST(Faults, BusyCoresChangeNothing) {
  std::atomic<bool> over = false;
  std::vector<std::thread> others;
  for (unsigned core = 0; core < std::max(1u, std::thread::hardware_concurrency()); ++core)
    others.emplace_back([&] {
      while (!over) continue;
    });
  const Outcome outcome = squall(run_on("omp", {"--threads", "2", "--frames", "20", "--json", "-"}));
  over = true;
  for (auto& other : others) other.join();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("runs").at(0).at("state_hash"), hash_after(20));
}

// Stopped for a second in mid-run, as by a debugger or a machine that swaps: a slow frame, and the same water.
TEST(Faults, AHitchOfASecondChangesNothing) {
  const TemporaryFolder folder;
  Program program(run_on("omp", {"--threads", "2", "--frames", "1000000", "--checkpoint", folder / "run.sqc",
                                 "--checkpoint-every", "0.01", "--json", folder / "run.json"}));
  for (int tries = 0; tries < 3000 && !std::filesystem::exists(folder / "run.sqc"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.stop();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  program.go_on();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  program.interrupt();
  ASSERT_EQ(program.wait().code, 130);
  const json row = json::parse(text_of(folder / "run.json")).at("runs").at(0);
  EXPECT_EQ(row["state_hash"], hash_after(row["frames"]));
}

}  // namespace
}  // namespace squall::app
