#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "harness/fake_solver.h"
#include "harness/results_csv.h"
#include "harness/results_json.h"

namespace squall::harness {
namespace {

Row fake_row() {
  const RunPlan plan = short_plan("fake, mapped");
  return run_once(make_fake(plan), plan);
}

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> result;
  for (const auto& entry : json.items()) result.push_back(entry.key());
  return result;
}

TEST(Json, HasTheNamesOfTheResultFormat) {
  const Json json = to_json(Context{}, {"small", "0123456789abcdef", 64}, {fake_row()}, std::nullopt);
  EXPECT_THAT(keys(json), testing::ElementsAre("schema", "context", "scene", "runs", "agreement"));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_TRUE(json["agreement"].is_null());
  EXPECT_THAT(keys(json["context"]), testing::IsSupersetOf({"squall_version", "git_revision", "date", "host", "cpu",
                                                            "cores", "threads", "compiler", "flags", "opencl"}));
  EXPECT_THAT(keys(json["scene"]), testing::ElementsAre("name", "hash", "particles"));
  ASSERT_EQ(json["runs"].size(), 1u);
  const Json& run = json["runs"][0];
  EXPECT_THAT(keys(run), testing::IsSupersetOf({"backend",
                                                "device",
                                                "threads",
                                                "simd",
                                                "precision",
                                                "pressure",
                                                "particles",
                                                "frames",
                                                "steps",
                                                "simulated_s",
                                                "wall_s",
                                                "realtime_factor",
                                                "fps",
                                                "frame_ms",
                                                "compute_ms",
                                                "readback_ms",
                                                "upload_ms",
                                                "readback_mode",
                                                "readback_bytes_per_frame",
                                                "readback_copied_bytes_per_frame",
                                                "readback_latency_frames",
                                                "readback_share",
                                                "phase_ms",
                                                "particle_steps_per_s",
                                                "pairs_per_s",
                                                "neighbours_mean",
                                                "iterations_mean",
                                                "density_error_mean",
                                                "density_error_max",
                                                "density_error_worst",
                                                "energy_drift",
                                                "clamps",
                                                "lost_particles",
                                                "state_hash"}));
  EXPECT_THAT(keys(run["frame_ms"]), testing::ElementsAre("median", "p95", "p99", "max"));
  EXPECT_EQ(run["readback_mode"], "mapped");
  EXPECT_EQ(run["state_hash"].get<std::string>().size(), 16u);
}

TEST(Json, OfDfsphTellsWhatSolvesTook) {
  Row row = fake_row();
  row.plan.settings.pressure = Pressure::wcsph;
  EXPECT_FALSE(to_json(row).contains("density_iterations"));
  row.plan.settings.pressure = Pressure::dfsph;
  row.density_iterations_mean = 3.5;
  row.density_iterations_max = 9;
  row.divergence_iterations_max = 2;
  row.unconverged = 4;
  row.light_passes_mean = 5.25;
  const Json untimed = to_json(row);
  EXPECT_EQ(untimed["density_iterations"], (Json{{"mean", 3.5}, {"max", 9}}));
  EXPECT_EQ(untimed["divergence_iterations"]["max"], 2);
  EXPECT_EQ(untimed["unconverged"], 4);
  EXPECT_EQ(untimed["light_passes_mean"], 5.25);
  EXPECT_TRUE(untimed["light_pass_ns"].is_null());
  row.light_pass_ns = 7.5;
  EXPECT_EQ(to_json(row)["light_pass_ns"], 7.5);
}

TEST(Json, OfAnErrorRowHasNoSpeed) {
  Row row = fake_row();
  row.error = "3 of 64 particles are lost";
  const Json run = to_json(Context{}, {}, {row}, std::nullopt)["runs"][0];
  EXPECT_EQ(run["error"], row.error);
  EXPECT_FALSE(run.contains("fps"));
  EXPECT_FALSE(run.contains("frame_ms"));
  EXPECT_TRUE(run.contains("lost_particles"));
}

TEST(Json, OfARunWithoutCountedFramesHasNoSpeed) {
  const RunPlan plan = short_plan("fake");
  const Row row = run_once(make_fake(plan), plan, [](const harness::Run&) { return false; });
  const Json run = to_json(Context{}, {}, {row}, std::nullopt)["runs"][0];
  EXPECT_EQ(run["interrupted"], true);
  EXPECT_FALSE(run.contains("fps"));
  EXPECT_FALSE(run.contains("error"));
  EXPECT_EQ(to_google_benchmark(Context{}, {}, {row})["benchmarks"][0]["error_occurred"], true);
  EXPECT_FALSE(to_json(Context{}, {}, {fake_row()}, std::nullopt)["runs"][0].contains("interrupted"));
}

TEST(Json, WritesNoInfinity) {
  Agreement agreement;
  agreement.bitwise = agreement.agree = false;
  agreement.first_difference_frame = 3;
  agreement.difference = Difference{5, std::numeric_limits<double>::infinity(), std::nan("")};
  const Json json = to_json(Context{}, {}, {}, agreement)["agreement"];
  EXPECT_EQ(json["bitwise"], false);
  EXPECT_EQ(json["first_difference_frame"], 3);
  EXPECT_EQ(json["first_difference_particle"], 5);
  EXPECT_TRUE(json["max_position_error_dx"].is_null());
  EXPECT_TRUE(json["max_velocity_error"].is_null());
}

TEST(GoogleBenchmark, HasWhatComparePyReads) {
  Row broken = fake_row();
  broken.error = "gone";
  const Json json = to_google_benchmark(Context{}, {"small", "", 64}, {fake_row(), broken});
  ASSERT_EQ(json["benchmarks"].size(), 2u);
  const Json& entry = json["benchmarks"][0];
  EXPECT_EQ(entry["name"], "small/fake, mapped");
  EXPECT_EQ(entry["run_name"], entry["name"]);
  EXPECT_EQ(entry["run_type"], "iteration");
  EXPECT_EQ(entry["iterations"], 6);
  EXPECT_EQ(entry["time_unit"], "ms");
  EXPECT_GT(entry["real_time"].get<double>(), 0.0);
  EXPECT_TRUE(entry["cpu_time"].is_number());
  EXPECT_FALSE(entry.contains("error_occurred"));
  EXPECT_EQ(json["benchmarks"][1]["error_occurred"], true);
  EXPECT_TRUE(json["context"].contains("date"));
}

std::size_t columns(const std::string& line) {
  std::size_t commas = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) ++commas;
  }
  return commas + 1;
}

TEST(Csv, EveryLineHasTheColumnsOfItsHeader) {
  std::ostringstream frames, series;
  write_frames_header(frames);
  write_frame(frames, "opencl 0, mapped", FrameRecord{});
  write_series_header(series);
  write_observation(series, Observation{});
  for (const auto& text : {frames.str(), series.str()}) {
    std::istringstream lines(text);
    std::string header, line;
    ASSERT_TRUE(std::getline(lines, header) && std::getline(lines, line));
    EXPECT_EQ(columns(header), columns(line)) << text;
  }
  EXPECT_NE(series.str().find("\n0,,,,,,,0,0\n"), std::string::npos) << series.str();  // lengths of nothing
}

TEST(Csv, ParticlesAreInWorldCoordinatesInOrderOfIds) {
  Scene scene = small_scene();
  Scene::Motion motion;
  motion.start_s = 0.0;
  motion.duration_s = 1.0;
  motion.acceleration_m_s2 = Eigen::Vector3d{2.0, 0.0, 0.0};
  scene.container.motions.push_back(motion);
  validate(scene);
  State state;
  state.clock.frame = 5;  // 0.5 s: moved by 0.25 m, at 1 m/s
  state.particles.add(2, {0.5, 0.25, 0.125}, {0.5, 0.0, 0.0});
  state.particles.add(1, {0.25, 0.25, 0.125}, {0.0, 0.0, -2.0});
  state.particles.add(0, Eigen::Vector3d::Constant(1e30), Eigen::Vector3d::Zero());
  std::ostringstream out;
  write_particles(out, scene, state);
  EXPECT_EQ(out.str(), "id,x,y,z,vx,vy,vz\n1,1.5,2.25,3.125,1,0,-2\n2,1.75,2.25,3.125,1.5,0,0\n");
}

// World coordinates are written as doubles, in as many digits as bring them back: what an origin 10 km away takes from
// a position is half a unit of a double there, 9.1e-13 m, and no single-precision position is lost.
TEST(ParticleFile, KeepsPositionsFarFromTheOrigin) {
  Scene scene = small_scene();
  const Eigen::Vector3d away(10000, 0, -10000);
  scene.container.max_m += away - scene.container.min_m;
  scene.container.min_m = away;
  State state;
  std::vector<Eigen::Vector3f> places;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const float at = 0.8f * static_cast<float>(i + 1) / 101.0f;
    places.emplace_back(at, 0.8f - at, 0.5f * at);
    state.particles.add(i, places.back().cast<double>(), Eigen::Vector3d::Zero());
  }
  std::stringstream text;
  write_particles(text, scene, state);
  std::string line;
  std::getline(text, line);
  for (const Eigen::Vector3f& place : places) {
    unsigned id = 0;
    Eigen::Vector3d x;
    ASSERT_TRUE(std::getline(text, line));
    ASSERT_EQ(std::sscanf(line.c_str(), "%u,%lf,%lf,%lf", &id, &x[0], &x[1], &x[2]), 4);
    EXPECT_LE((x - away - place.cast<double>()).cwiseAbs().maxCoeff(), std::ldexp(1.0, 13 - 53));
    EXPECT_EQ((x - away).cast<float>(), place) << "particle " << id;
  }
}

}  // namespace
}  // namespace squall::harness
