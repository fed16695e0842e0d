#include "harness/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <sstream>

#include "harness/fake_solver.h"
#include "harness/sweep_report.h"
#include "harness/sweep_results.h"
#include "harness/sweep_tables.h"

namespace squall::harness {
namespace {

using MakeFake = std::function<std::unique_ptr<Solver>(const Scene& scene, const RunPlan& plan)>;

std::unique_ptr<Solver> fake(const Scene& scene, const RunPlan& plan, Faults faults = {}) {
  auto solver = std::make_unique<FakeSolver>(scene, plan.settings, faults);
  solver->load(initial_particles(scene));
  return solver;
}

SceneAt scenes(MakeFake make = [](const Scene& scene, const RunPlan& plan) { return fake(scene, plan); }) {
  return [make](std::int64_t particles) {
    Scene scene = small_scene();
    const std::int64_t count = scale_to_particles(scene, particles);
    return SizedScene{{count, scene.fluid.spacing_m, scene_hash(scene)},
                      [scene, make](const RunPlan& plan) { return make(scene, plan); }};
  };
}

SweepPlan two_runs(std::vector<std::int64_t> sizes) {
  SweepPlan plan;
  plan.runs = {short_plan("omp, 1 thread", "omp"), short_plan("opencl 0", "opencl")};
  plan.runs[0].settings.threads = 1;
  plan.sizes = std::move(sizes);
  return plan;
}

TEST(Sweep, MeasuresEveryRunAtEverySizeInAscendingOrder) {
  int rounds = 0;
  std::size_t sizes_told = 0;
  const auto result = sweep(
      scenes(), two_runs({512, 64}),
      [&](const SweepProgress& progress) {
        ++rounds;
        EXPECT_GE(progress.share, 0.0);
        EXPECT_LE(progress.share, 1.0);
        EXPECT_GE(progress.left_s, 0.0);
        return true;
      },
      [&](const auto& points) { sizes_told += points.size() == 2 ? 1 : 0; });
  EXPECT_EQ(rounds, 2 * 8);
  EXPECT_EQ(sizes_told, 2u);
  ASSERT_EQ(result.points.size(), 4u);
  EXPECT_EQ(result.points[0].row.particles, 64);
  EXPECT_EQ(result.points[3].row.particles, 512);
  EXPECT_EQ(result.points[0].speedup, 1.0);
  ASSERT_TRUE(result.points[3].speedup);
  EXPECT_EQ(*result.points[3].speedup, result.points[2].row.frame_ms.median / result.points[3].row.frame_ms.median);
  ASSERT_EQ(result.crossovers.size(), 1u);
  EXPECT_EQ(result.crossovers[0].leads.size(), 2u);
  EXPECT_THAT(result.crossovers[0].against, testing::ElementsAre("omp, 1 thread"));
  EXPECT_TRUE(overall_agreement(result).agree);
  EXPECT_EQ(overall_agreement(result).bitwise, true);
  EXPECT_TRUE(result.budget.empty());
}

TEST(Sweep, SizesThatScaleToOneSceneAreMeasuredOnce) {
  const auto result = sweep(scenes(), two_runs({64, 65, 64}));
  EXPECT_EQ(result.sizes.size(), 1u);
  EXPECT_THROW(sweep(scenes(), two_runs({})), InputError);
}

TEST(Sweep, ATimeLimitEndsItAndIsSaid) {
  auto plan = two_runs({64, 512, 1728});
  plan.limit_s = 0.0;
  const auto result = sweep(scenes(), plan);
  EXPECT_EQ(result.sizes.size(), 1u) << "the first size is always measured";
  EXPECT_THAT(result.notes, testing::ElementsAre(testing::HasSubstr("all runs stopped before 512 particles")));
}

TEST(Sweep, NamesTheSizeThatDisagrees) {
  const auto result = sweep(scenes([](const Scene& scene, const RunPlan& plan) {
                              Faults faults;
                              if (plan.backend == "opencl" && scene.fluid.spacing_m < 0.06) faults.differs_from = 3;
                              return fake(scene, plan, faults);
                            }),
                            two_runs({64, 512}));
  EXPECT_TRUE(result.sizes[0].agreement.agree);
  EXPECT_FALSE(result.sizes[1].agreement.agree);
  const auto all = overall_agreement(result);
  EXPECT_FALSE(all.agree);
  EXPECT_EQ(all.first_difference_frame, 3u);
  EXPECT_THAT(all.verdict, testing::HasSubstr("at 512 particles: "));
}

TEST(Sweep, ADeviceThatFailedIsNotAskedForMore) {
  const auto result = sweep(scenes([](const Scene& scene, const RunPlan& plan) -> std::unique_ptr<Solver> {
                              if (plan.backend == "opencl" && scene.fluid.spacing_m < 0.06)
                                throw DeviceError("no memory");
                              return fake(scene, plan);
                            }),
                            two_runs({64, 512, 1728}));
  ASSERT_EQ(result.points.size(), 2u + 2u + 1u);
  EXPECT_TRUE(result.points[3].row.device_failed);
  EXPECT_FALSE(result.points[3].speedup);
  EXPECT_EQ(result.points[4].row.plan.backend, "omp");
  EXPECT_EQ(result.crossovers[0].leads.size(), 1u);
}

TEST(Sweep, WhatWasMeasuredIsKeptWhereASizeIsRefused) {
  const auto refusing = scenes([](const Scene& scene, const RunPlan& plan) {
    if (scene.fluid.spacing_m < 0.06) throw InputError("the grid is too large");
    return fake(scene, plan);
  });
  const auto result = sweep(refusing, two_runs({64, 512}));
  EXPECT_EQ(result.problem, SizeProblem::scene);
  EXPECT_EQ(result.points.size(), 2u);
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("the grid is too large")));
  EXPECT_THROW(sweep(refusing, two_runs({512})), InputError) << "nothing was measured";
}

TEST(Sweep, WhatWasMeasuredIsKeptWhereMemoryEnds) {
  const auto result = sweep(scenes([](const Scene& scene, const RunPlan& plan) {
                              if (scene.fluid.spacing_m < 0.06) throw std::bad_alloc();
                              return fake(scene, plan);
                            }),
                            two_runs({64, 512}));
  EXPECT_EQ(result.problem, SizeProblem::memory);
  EXPECT_EQ(result.points.size(), 2u);
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("before 512 particles")));
}

TEST(Sweep, StopsWhenAskedAndComparesNothingThatWasCutShort) {
  int rounds = 0;
  auto plan = two_runs({64, 512});
  plan.budget_ms = 1e6;
  const auto result = sweep(scenes(), plan, [&](const SweepProgress&) { return ++rounds < 12; });
  EXPECT_TRUE(result.interrupted);
  ASSERT_EQ(result.points.size(), 4u);
  EXPECT_TRUE(result.points[3].row.interrupted);
  EXPECT_FALSE(result.points[3].speedup);
  EXPECT_EQ(result.crossovers[0].leads.size(), 1u);
  EXPECT_EQ(result.budget[0].largest->row.particles, 64) << "512 was cut short";
}

TEST(Sweep, FewerThreadsThanNamedAreSaid) {
  auto plan = two_runs({64});
  plan.runs[0].settings.threads = 3;  // the fake always uses one
  EXPECT_THAT(sweep(scenes(), plan).notes, testing::ElementsAre(testing::HasSubstr("threads used: 1 at 64")));
}

SweepResult measured_result() {
  SweepResult result;
  result.plan = two_runs({64, 512});
  result.plan.budget_ms = 1e6;
  result.sweep = sweep(scenes(), result.plan);
  result.scene = {"small <&> \xff", "0123456789abcdef", 64};
  result.frame_rate_hz = 10.0;
  return result;
}

TEST(SweepResults, JsonHoldsWholeRowsUnderStableNames) {
  const Json json = to_json(measured_result());
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["measured"]["from_s"], 0.2);
  EXPECT_EQ(json["measured"]["to_s"], 0.8);
  ASSERT_EQ(json["points"].size(), 4u);
  for (const char* name : {"label", "backend", "frame_ms", "readback_mode", "phase_ms", "state_hash", "speedup",
                           "scene_particles", "spacing_m", "scene_hash"})
    EXPECT_TRUE(json["points"][3].contains(name)) << name;
  EXPECT_EQ(json["sizes"].size(), 2u);
  EXPECT_EQ(json["sizes"][0]["agreement"]["bitwise"], true);
  EXPECT_EQ(json["crossover"][0]["leads"].size(), 2u);
  EXPECT_EQ(json["budget"]["runs"][1]["fit"], "all");
  EXPECT_EQ(json["budget"]["runs"][1]["largest"]["particles"], 512);
  EXPECT_EQ(json["agreement"]["bitwise"], true);
  EXPECT_FALSE(json.contains("interrupted"));
  EXPECT_NO_THROW(json_text(json)) << "a scene's name need not be UTF-8";
}

std::size_t fields_in(const std::string& line) {
  std::size_t fields = 1;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) ++fields;
  }
  return fields;
}

TEST(SweepResults, EveryLineOfTheCsvHasTheFieldsOfTheHeader) {
  auto points = measured_result().sweep.points;
  points.front().row.error = "it said \"no\", twice\nor so";
  std::ostringstream out;
  write_points_header(out);
  for (const auto& point : points) write_point(out, point);
  std::istringstream lines(out.str());
  std::string header, line;
  std::getline(lines, header);
  for (const auto& point : points) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(fields_in(line), fields_in(header)) << line;
    EXPECT_EQ(line.find("\"" + point.row.plan.label + "\","), 0u);
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(SweepResults, TablesShowErrorsAndGaps) {
  auto result = measured_result();
  result.sweep.points[1].row.error = "lost";
  result.sweep.points.pop_back();
  const auto tables = size_tables(result);
  ASSERT_EQ(tables.size(), 4u);
  EXPECT_THAT(tables[0].header, testing::ElementsAre("particles", "omp, 1 thread", "opencl 0"));
  EXPECT_THAT(tables[0].rows[0], testing::ElementsAre("64", testing::_, "error"));
  EXPECT_THAT(tables[0].rows[1], testing::ElementsAre("512", testing::_, "-"));
}

TEST(SweepReport, PlotsShowWhatWasMeasured) {
  auto result = measured_result();
  result.sweep.points[1].row.error = "lost";
  const auto plots = sweep_plots(result);
  ASSERT_EQ(plots.size(), 4u);
  EXPECT_EQ(plots[0].name, "fps");
  EXPECT_EQ(plots[0].series[0].samples.size(), 2u);
  EXPECT_EQ(plots[0].series[1].samples.size(), 1u);
  EXPECT_EQ(plots[0].series[1].samples[0].y, result.sweep.points[3].row.fps);
  EXPECT_EQ(plots[2].marks[0].y, 1e6);
  result.plan.runs[0].backend = "opencl";
  for (auto& point : result.sweep.points) point.speedup.reset();
  EXPECT_EQ(sweep_plots(result).size(), 3u) << "no speed-up without one thread of omp";
}

TEST(SweepReport, NamesAreTextAndNeverMarkup) {
  const std::string page = sweep_html(measured_result(), {});
  EXPECT_NE(page.find("small &lt;&amp;&gt; \xef\xbf\xbd"), std::string::npos);
  EXPECT_EQ(page.find("<&>"), std::string::npos);
}

}  // namespace
}  // namespace squall::harness
