// Every scene of scenes/ with every pressure solver ends in the state that tests/golden/hashes.txt has a hash of. So
// that a change in results is seen, also one that all backends make alike; the file is written by scripts/golden.sh, on
// the reference.
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/state_hash.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

struct Golden {
  std::string scene;
  std::string pressure;
  std::int64_t particles = 0;  ///< as for --particles
  int frames = 0;
  std::string hash;

  std::string name() const { return scene + "_" + pressure; }
};

/// Lines of the file; `#` begins a comment.
std::vector<Golden> golden_hashes() {
  std::vector<Golden> all;
  std::ifstream file(SQUALL_GOLDEN_HASHES);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    Golden golden;
    std::istringstream(line) >> golden.scene >> golden.pressure >> golden.particles >> golden.frames >> golden.hash;
    all.push_back(golden);
  }
  return all;
}

Scene scene_named(const std::string& name) { return load_scene(SQUALL_SCENES_DIR "/" + name + ".toml"); }

/// "collapse_wcsph", ...: what there must be a hash of.
std::vector<std::string> names_wanted() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SQUALL_SCENES_DIR)) {
    const std::string scene = entry.path().stem().string();
    if (entry.path().extension() != ".toml") continue;
    for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph})
      if (scene_named(scene).solver.pressure.value_or(pressure) == pressure)
        names.push_back(scene + "_" + to_string(pressure));
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(GoldenHashes, AreThereForEverySceneAndPressureSolver) {
  std::vector<std::string> names;
  for (const Golden& golden : golden_hashes()) names.push_back(golden.name());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, names_wanted()) << "scripts/golden.sh writes them; " << SQUALL_GOLDEN_HASHES;
}

struct GoldenRun {
  BackendUnderTest backend;
  Golden golden;
};

void PrintTo(const GoldenRun& run, std::ostream* out) { *out << run.golden.name() << " on " << run.backend.name; }

std::vector<GoldenRun> golden_runs() {
  std::vector<GoldenRun> runs;
  for (const Golden& golden : golden_hashes()) {
    const Pressure pressure = pressure_from_text(golden.pressure);
    runs.push_back({omp("2_threads", 2, Simd::best, pressure), golden});
    runs.push_back({opencl("by_device", Simd::best, pressure), golden});
  }
  return runs;
}

class GoldenHash : public testing::TestWithParam<GoldenRun> {};

INSTANTIATE_TEST_SUITE_P(Backends, GoldenHash, testing::ValuesIn(golden_runs()),
                         [](const auto& info) { return info.param.backend.name + "_" + info.param.golden.name(); });

TEST_P(GoldenHash, IsThatOfTheFile) {
  const Golden& golden = GetParam().golden;
  Scene scene = scene_named(golden.scene);
  scale_to_particles(scene, golden.particles);
  const auto solver = GetParam().backend.make(scene);
  const std::uint64_t start = state_hash(solver->state().particles, Precision::single_precision);
  for (int frame = 0; frame < golden.frames; ++frame) {
    const FrameReport& report = solver->advance(Delivery::nothing);
    ASSERT_EQ(report.lost, 0) << "frame " << frame;
  }
  const State end = solver->state();
  const std::uint64_t hash = state_hash(end.particles, Precision::single_precision);
  EXPECT_NE(hash, start) << "nothing moved";
  EXPECT_TRUE(all_finite(end.particles));
  EXPECT_EQ(hash_text(hash), golden.hash)
      << "results have changed. If they were meant to: scripts/golden.sh, in a commit of its own that says why "
         "(CONTRIBUTING.md)";
}

}  // namespace
}  // namespace squall::test
