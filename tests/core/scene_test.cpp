#include "core/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "core/errors.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using squall::parse_scene;
using squall::Pressure;
using squall::print_scene;
using squall::Scene;
using squall::scene_hash;
using testing::ElementsAre;
using testing::MatchesRegex;

const std::string k_smallest = R"(schema = 1
[time]
duration_s = 1
[fluid]
spacing_m = 0.1
[container]
min_m = [0, 0, 0]
max_m = [1, 2, 1]
)";

Scene smallest_with(const std::string& more) { return parse_scene(k_smallest + more, "smallest.toml"); }

// ---- the scenes that come with the project ---------------------------------------------------------------------

struct Shipped {
  const char* name;
  std::size_t particles;
  std::int64_t capacity;
  double depth_m;
};

void PrintTo(const Shipped& shipped, std::ostream* out) { *out << shipped.name; }

class ShippedScene : public testing::TestWithParam<Shipped> {
 protected:
  std::string path = std::string(SQUALL_SCENES_DIR) + "/" + GetParam().name + ".toml";
  Scene scene = squall::load_scene(path);
};

TEST_P(ShippedScene, HasItsParticleCountAndDepth) {
  EXPECT_EQ(scene.name, GetParam().name);
  EXPECT_EQ(initial_particles(scene).size(), GetParam().particles);
  EXPECT_EQ(particle_capacity(scene), GetParam().capacity);
  EXPECT_EQ(scene.fluid_depth(), GetParam().depth_m);
}

TEST_P(ShippedScene, ReadsBackFromItsPrint) {
  const std::string text = print_scene(scene);
  const Scene again = parse_scene(text, path);
  EXPECT_EQ(print_scene(again), text);
  EXPECT_EQ(scene_hash(again), scene_hash(scene));
  EXPECT_EQ(again.name, scene.name);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScene,
                         testing::Values(Shipped{"collapse", 11664, 11664, 0.8},
                                         Shipped{"collapse_2016", 11664, 11664, 0.8},
                                         Shipped{"drop", 11664, 11664, 1.2}, Shipped{"rain", 0, 4000, 0.8},
                                         Shipped{"still", 1000, 1000, 0.2}, Shipped{"free_fall", 1000, 1000, 0.9}),
                         [](const auto& info) { return info.param.name; });

TEST(ShippedScenes, AreAllTestedAboveAndDifferFromEachOther) {
  std::vector<std::string> names, hashes;
  for (const auto& entry : std::filesystem::directory_iterator(SQUALL_SCENES_DIR)) {
    if (entry.path().extension() != ".toml") continue;
    names.push_back(entry.path().stem().string());
    hashes.push_back(scene_hash(squall::load_scene(entry.path().string())));
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"collapse", "collapse_2016", "drop", "rain", "still", "free_fall"}));
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::unique(hashes.begin(), hashes.end()), hashes.end());
}

TEST(ShippedScenes, RainWaterIsWhatItsCommentSays) {
  const Scene scene = squall::load_scene(std::string(SQUALL_SCENES_DIR) + "/rain.toml");
  const double base = scene.container_size().x() * scene.container_size().z();
  const double volume_per_s = *scene.rains.at(0).particles_per_s * scene.particle_volume();
  EXPECT_NEAR(volume_per_s / base * 3.6e6, 494 * 100.0, 50.0);  // mm/h, to the last digit of 494
  EXPECT_NEAR(scene.particle_mass(), 0.011, 0.0005);            // kg
}

TEST(ShippedScenes, TheReportsPressureIsForcedInItsOwnScene) {
  const Scene scene = squall::load_scene(std::string(SQUALL_SCENES_DIR) + "/collapse_2016.toml");
  EXPECT_EQ(scene.solver.pressure, Pressure::mueller);
  EXPECT_TRUE(scene.solver.negative_pressure);
  EXPECT_EQ(scene.solver.stiffness_m2_s2, 3.0);
}

// ---- reading ---------------------------------------------------------------------------------------------------

TEST(SceneReader, GivesWhatIsNotWrittenItsDefault) {
  const Scene scene = parse_scene(k_smallest, "folder/my scene.toml");
  EXPECT_EQ(scene.name, "my scene");
  EXPECT_EQ(scene.time.frame_rate_hz, 60.0);
  EXPECT_EQ(scene.fluid.support_ratio, 2.0);
  EXPECT_EQ(scene.fluid.rest_density_kg_m3, 1000.0);
  EXPECT_FALSE(scene.fluid.viscosity_m2_s);
  EXPECT_FALSE(scene.solver.pressure);
  EXPECT_EQ(scene.solver.dt_max_s, 0.005);
  EXPECT_EQ(scene.solver.stiffness_m2_s2, 400.0);
  EXPECT_FALSE(scene.solver.speed_of_sound_m_s);
  EXPECT_EQ(scene.gravity_m_s2, Vector3d(0.0, -9.81, 0.0));
  EXPECT_FALSE(scene.container.open_top);
  EXPECT_EQ(particle_capacity(scene), 0);
}

TEST(SceneReader, AcceptsAnEmptyScene) { EXPECT_EQ(initial_particles(smallest_with("")).size(), 0u); }

TEST(SceneReader, ReadsEveryKey) {
  const Scene scene = parse_scene(R"(schema = 1
[time]
duration_s = 3.5
frame_rate_hz = 50
[fluid]
spacing_m = 0.125
support_ratio = 2.5
rest_density_kg_m3 = 998.2
viscosity_m2_s = 1e-6
[solver]
pressure = "mueller"
density_tolerance = 1e-4
divergence_tolerance = 2e-4
max_iterations = 7
dt_max_s = 0.001
cfl = 0.3
xsph = 0
stiffness_m2_s2 = 785
speed_of_sound_m_s = 42
artificial_viscosity = 0.2
negative_pressure = true
[gravity]
vector_m_s2 = [1, -2, 3]
[container]
min_m = [-1, -2, -3]
max_m = [1, 2, 3]
open_top = true
[[container.motion]]
start_s = 0.25
duration_s = 0.5
acceleration_m_s2 = [4, 5, 6]
[[container.motion]]
start_s = 1
duration_s = 2
displacement_m = [7, 8, 9]
[[box]]
min_m = [0, -2, 0]
max_m = [0.5, -1, 1]
until_s = 0.75
[[block]]
min_m = [-1, -2, -3]
max_m = [-0.5, 1, -1]
velocity_m_s = [0.5, 0.25, 0.125]
held_until_s = 0.0625
[[rain]]
rate_mm_h = 100
drop_diameter_mm = 2
area_min_m = [-0.5, -1]
area_max_m = [0.5, 1]
height_m = 2.5
wind_m_s = [3, 0, -3]
start_s = 0.5
stop_s = 1.5
max_particles = 99
)",
                                  "all.toml");
  EXPECT_EQ(scene.time.duration_s, 3.5);
  EXPECT_EQ(scene.time.frame_rate_hz, 50.0);
  EXPECT_EQ(scene.fluid.spacing_m, 0.125);
  EXPECT_EQ(scene.fluid.support_ratio, 2.5);
  EXPECT_EQ(scene.fluid.rest_density_kg_m3, 998.2);
  EXPECT_EQ(scene.fluid.viscosity_m2_s, 1e-6);
  EXPECT_EQ(scene.solver.pressure, Pressure::mueller);
  EXPECT_EQ(scene.solver.density_tolerance, 1e-4);
  EXPECT_EQ(scene.solver.divergence_tolerance, 2e-4);
  EXPECT_EQ(scene.solver.max_iterations, 7);
  EXPECT_EQ(scene.solver.dt_max_s, 0.001);
  EXPECT_EQ(scene.solver.cfl, 0.3);
  EXPECT_EQ(scene.solver.stiffness_m2_s2, 785.0);
  EXPECT_EQ(scene.speed_of_sound(), 42.0);
  EXPECT_EQ(scene.solver.artificial_viscosity, 0.2);
  EXPECT_TRUE(scene.solver.negative_pressure);
  EXPECT_EQ(scene.gravity_m_s2, Vector3d(1, -2, 3));
  EXPECT_EQ(scene.container.min_m, Vector3d(-1, -2, -3));
  EXPECT_EQ(scene.container_size(), Vector3d(2, 4, 6));
  EXPECT_TRUE(scene.container.open_top);
  ASSERT_EQ(scene.container.motions.size(), 2u);
  EXPECT_EQ(scene.container.motions[0].start_s, 0.25);
  EXPECT_EQ(scene.container.motions[0].acceleration_m_s2, Vector3d(4, 5, 6));
  EXPECT_FALSE(scene.container.motions[0].displacement_m);
  EXPECT_EQ(scene.container.motions[1].duration_s, 2.0);
  EXPECT_EQ(scene.container.motions[1].displacement_m, Vector3d(7, 8, 9));
  ASSERT_EQ(scene.boxes.size(), 1u);
  EXPECT_EQ(scene.boxes[0].max_m, Vector3d(0.5, -1, 1));
  EXPECT_EQ(scene.boxes[0].until_s, 0.75);
  ASSERT_EQ(scene.blocks.size(), 1u);
  EXPECT_EQ(scene.blocks[0].velocity_m_s, Vector3d(0.5, 0.25, 0.125));
  EXPECT_EQ(scene.blocks[0].held_until_s, 0.0625);
  ASSERT_EQ(scene.rains.size(), 1u);
  EXPECT_EQ(scene.rains[0].rate_mm_h, 100.0);
  EXPECT_FALSE(scene.rains[0].particles_per_s);
  EXPECT_EQ(scene.rains[0].drop_diameter_mm, 2.0);
  EXPECT_EQ(scene.rains[0].area_min_m, Vector2d(-0.5, -1));
  EXPECT_EQ(scene.rains[0].area_max_m, Vector2d(0.5, 1));
  EXPECT_EQ(scene.rains[0].height_m, 2.5);
  EXPECT_EQ(scene.rains[0].wind_m_s, Vector3d(3, 0, -3));
  EXPECT_EQ(scene.rains[0].start_s, 0.5);
  EXPECT_EQ(scene.rains[0].stop_s, 1.5);
  EXPECT_EQ(scene.rains[0].max_particles, 99);
  EXPECT_EQ(print_scene(parse_scene(print_scene(scene), "all.toml")), print_scene(scene));
}

// ---- printing --------------------------------------------------------------------------------------------------

/// A double with all its bits in use, in (0, 1).
double odd_number(std::mt19937_64& random) { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; }

TEST(ScenePrinter, KeepsEveryBitOfEveryNumber) {
  std::mt19937_64 random(2016);
  for (int repeat = 0; repeat < 200; ++repeat) {
    Scene scene = smallest_with("");
    scene.time.duration_s = 1.0 + 100.0 * odd_number(random);
    scene.fluid.spacing_m = 1e-3 + 0.1 * odd_number(random);
    scene.fluid.viscosity_m2_s = std::pow(odd_number(random), 20.0);
    scene.gravity_m_s2 = {odd_number(random), -9.81 * odd_number(random), -odd_number(random)};
    scene.container.max_m = {1.0 + odd_number(random), 2.0, 900.0 * odd_number(random) + 1.0};
    const Scene again = parse_scene(print_scene(scene), "smallest.toml");
    EXPECT_EQ(again.time.duration_s, scene.time.duration_s);
    EXPECT_EQ(again.fluid.spacing_m, scene.fluid.spacing_m);
    EXPECT_EQ(again.fluid.viscosity_m2_s, scene.fluid.viscosity_m2_s);
    EXPECT_EQ(again.gravity_m_s2, scene.gravity_m_s2);
    EXPECT_EQ(again.container.max_m, scene.container.max_m);
  }
}

TEST(ScenePrinter, LeavesOutWhatIsNotSet) {
  const std::string text = print_scene(smallest_with(""));
  EXPECT_EQ(text.find("viscosity_m2_s"), std::string::npos);
  EXPECT_EQ(text.find("\npressure ="), std::string::npos);
  EXPECT_EQ(text.find("[["), std::string::npos);
}

// ---- identity --------------------------------------------------------------------------------------------------

TEST(SceneHash, IsSixteenHexDigits) { EXPECT_THAT(scene_hash(smallest_with("")), MatchesRegex("[0-9a-f]+")); }

TEST(SceneHash, IsTheSameForFilesThatMeanTheSame) {
  const Scene scene = smallest_with("");
  const Scene same = parse_scene(R"(# a comment, another order, defaults written out, -0
schema = 1
container = {max_m = [1.0, 2.0, 1.0], open_top = false, min_m = [0.0, -0.0, 0]}
time.frame_rate_hz = 6e1
time.duration_s = 1.0
[fluid]
support_ratio = 2
spacing_m = 1e-1
)",
                                 "other name.toml");
  EXPECT_EQ(scene_hash(scene), scene_hash(same));
  EXPECT_EQ(scene_hash(scene).size(), 16u);
}

TEST(SceneHash, ChangesWithEveryKey) {
  const std::string hash = scene_hash(smallest_with(""));
  Scene longer = smallest_with("");
  longer.time.duration_s = std::nextafter(1.0, 2.0);
  EXPECT_NE(scene_hash(longer), hash);
  EXPECT_NE(scene_hash(smallest_with("[solver]\npressure = 'wcsph'\n")), hash);
  EXPECT_NE(scene_hash(smallest_with("[[box]]\nmin_m = [0, 0, 0]\nmax_m = [0.5, 0.5, 0.5]\n")), hash);
}

// ---- depth and speed of sound ----------------------------------------------------------------------------------

TEST(FluidDepth, IsTheTopOfTheHighestBlockAboveTheFloor) {
  const std::string blocks =
      "[[block]]\nmin_m = [0, 0.5, 0]\nmax_m = [1, 1.5, 1]\n[[block]]\nmin_m = [0, 0, 0]\nmax_m = [1, 0.5, 1]\n";
  EXPECT_EQ(smallest_with(blocks).fluid_depth(), 1.5);
  EXPECT_EQ(smallest_with("").fluid_depth(), 2.0);
  Scene lowered = smallest_with(blocks);
  lowered.container.min_m.y() = -1.0;
  EXPECT_EQ(lowered.fluid_depth(), 2.5);
}

TEST(SpeedOfSound, IsTenTimesTheSpeedTheWaterWillReach) {
  Scene scene = smallest_with("[[block]]\nmin_m = [0, 0, 0]\nmax_m = [1, 1, 1]\n");
  EXPECT_DOUBLE_EQ(scene.speed_of_sound(), 10.0 * std::sqrt(9.81));
  scene.gravity_m_s2 = {3.0, 4.0, 0.0};
  EXPECT_DOUBLE_EQ(scene.speed_of_sound(), 10.0 * std::sqrt(5.0));
  scene.gravity_m_s2.setZero();
  EXPECT_EQ(scene.speed_of_sound(), 10.0);
  scene.blocks[0].velocity_m_s = {0.0, 0.0, -3.0};
  EXPECT_EQ(scene.speed_of_sound(), 30.0);
  scene.solver.speed_of_sound_m_s = 5.0;
  EXPECT_EQ(scene.speed_of_sound(), 5.0);
}

// ---- particle files --------------------------------------------------------------------------------------------

class SceneWithParticleFile : public testing::Test {
 protected:
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "squall scene with particle file";

  void SetUp() override { std::filesystem::create_directories(folder / "data"); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
  }
};

TEST_F(SceneWithParticleFile, FindsTheFileBesideTheSceneAndPrintsItsPathAsWritten) {
  write("data/two.csv", "x,y,z,vx,vy,vz\n0.25,0.5,0.75,1,2,3\n0.5,0.5,0.5,0,0,0\n");
  const std::string path = write("scene.toml", k_smallest + "[[particles]]\nfile = \"data/two.csv\"\n");
  const Scene scene = squall::load_scene(path);
  const squall::Particles particles = initial_particles(scene);
  EXPECT_THAT(particles.ids, ElementsAre(0u, 1u));
  EXPECT_THAT(particles.positions, ElementsAre(Vector3d(0.25, 0.5, 0.75), Vector3d(0.5, 0.5, 0.5)));
  EXPECT_THAT(particles.velocities, ElementsAre(Vector3d(1, 2, 3), Vector3d(0, 0, 0)));
  const Scene again = squall::load_scene(write("printed.toml", print_scene(scene)));
  EXPECT_EQ(again.particle_files.at(0).file, "data/two.csv");
  EXPECT_EQ(scene_hash(again), scene_hash(scene));
}

TEST_F(SceneWithParticleFile, IsKnownByWhatIsInTheFileNotByItsPath) {
  const std::string csv = "x,y,z,vx,vy,vz\n0.25,0.5,0.75,1,2,3\n";
  write("one.csv", csv);
  write("data/moved \"1\".csv", csv);
  write("other.csv", "x,y,z,vx,vy,vz\n0.25,0.5,0.75,1,2,4\n");
  const auto hash_with = [&](const std::string& file) {
    return scene_hash(squall::load_scene(write("scene.toml", k_smallest + "[[particles]]\nfile = '" + file + "'\n")));
  };
  EXPECT_EQ(hash_with("one.csv"), hash_with("data/moved \"1\".csv"));
  EXPECT_NE(hash_with("one.csv"), hash_with("other.csv"));
}

TEST_F(SceneWithParticleFile, SaysWhereAMissingFileIsNamedAndWhereABadOneIsWrong) {
  const auto refusal = [&](const std::string& file) -> std::string {
    try {
      squall::load_scene(write("scene.toml", k_smallest + "[[particles]]\nfile = '" + file + "'\n"));
    } catch (const squall::InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal("none.csv"), testing::StartsWith((folder / "scene.toml:10:8: ").string()));
  write("bad.csv", "x,y,z,vx,vy,vz\n0.25,0.5,zero,1,2,3\n");
  EXPECT_THAT(refusal("bad.csv"), testing::StartsWith((folder / "bad.csv:2:10: ").string()));
}

}  // namespace
