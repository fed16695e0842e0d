#include "harness/sweep_analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "harness/fake_solver.h"

namespace squall::harness {
namespace {

// Positions come from a logarithm, a division and an exponential: a few roundings each of numbers around 10.
constexpr double k_relative = 1e-13;

Row row(const std::string& label, const std::string& backend, int threads, double frame_ms,
        std::int64_t particles = 1000) {
  Row result;
  result.plan = short_plan(label, backend);
  result.plan.settings.threads = threads;
  result.particles = particles;
  result.frames = 6;
  result.frame_ms.median = frame_ms;
  return result;
}

SweepPoint point(std::int64_t particles, double frame_ms) {
  return {{particles, 0.1, std::to_string(particles)}, row("omp", "omp", 1, frame_ms, particles), {}};
}

std::vector<Lead> leads(const std::vector<std::pair<std::int64_t, double>>& ratios) {
  std::vector<Lead> result;
  for (const auto& [particles, ratio] : ratios)
    result.push_back({particles, "omp", ratio, Interval{ratio * 0.99, ratio * 1.01, 0.95}});
  return result;
}

TEST(SizeLadder, DoublesTheScenesOwnCountFromAboveAThousand) {
  EXPECT_THAT(size_ladder(11664, 50000), testing::ElementsAre(1458, 2916, 5832, 11664, 23328, 46656));
  EXPECT_THAT(size_ladder(60, 4000), testing::ElementsAre(1920, 3840));
  EXPECT_THAT(size_ladder(1000, 1000), testing::ElementsAre(1000));
  EXPECT_THAT(size_ladder(3000, 1000), testing::IsEmpty()) << "1,500 is beyond the largest allowed";
  EXPECT_THAT(size_ladder(0, 1000), testing::IsEmpty());
}

TEST(TimeLimit, KeepsAllThatFit) {
  // 8 times the particles take 16 times as long: 2 s become 32 s.
  EXPECT_DOUBLE_EQ(growth_of_time(8.0), 16.0);
  EXPECT_THAT(runs_with_time({1.0, 1.0}, 2.0, 8.0, 32.5), testing::ElementsAre(0, 1));
  EXPECT_THAT(runs_with_time({1.0, 1.0}, 2.0, 8.0, 31.5), testing::IsEmpty()) << "none is slow beside the other";
}

TEST(TimeLimit, LeavesOutWhatIsMuchSlowerThanTheFastest) {
  EXPECT_THAT(runs_with_time({9.0, 1.0, 0.5}, 10.5, 8.0, 30.0), testing::ElementsAre(1, 2));
  EXPECT_THAT(runs_with_time({9.0, 1.0, 0.5}, 10.5, 8.0, 20.0), testing::IsEmpty());
  EXPECT_THAT(runs_with_time({}, 1.0, 2.0, 100.0), testing::IsEmpty());
}

TEST(TimeLimit, TheLastSizeFillsTheTimeLeft) {
  // 16 times the time, less a reserve, is a little under 8 times the particles.
  const auto ratio = last_size_with_time(2.0, 32.0);
  ASSERT_TRUE(ratio);
  EXPECT_LT(*ratio, 8.0);
  EXPECT_LT(2.0 * growth_of_time(*ratio), 32.0);
  EXPECT_GT(2.0 * growth_of_time(*ratio), 25.0);
  EXPECT_FALSE(last_size_with_time(2.0, 2.0)) << "that would be the last size again";
  EXPECT_FALSE(last_size_with_time(2.0, -1.0));
  EXPECT_FALSE(last_size_with_time(0.0, 10.0));
}

TEST(Curve, IsAscendingAndHasOnlyWhatWasMeasured) {
  auto failed = point(500, 9.0), cut_short = point(600, 9.0), none = point(700, 0.0), other = point(800, 9.0);
  failed.row.error = "lost";
  cut_short.row.interrupted = true;
  none.row.frames = 0;
  other.row.plan.label = "opencl";
  const auto curve = curve_of({point(2000, 4.0), failed, cut_short, none, other, point(1000, 2.0)}, "omp");
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_EQ(curve[0].particles, 1000.0);
  EXPECT_EQ(curve[1].frame_ms, 4.0);
  EXPECT_TRUE(curve_of({}, "omp").empty());
}

TEST(Speedups, AreAgainstOneThreadOfOmp) {
  std::vector<Row> rows{row("omp, 2", "omp", 2, 5.0), row("omp, 1", "omp", 1, 8.0), row("cl", "opencl", 1, 16.0),
                        row("cl bad", "opencl", 0, 1.0)};
  rows[3].error = "lost";
  EXPECT_THAT(speedups(rows), testing::ElementsAre(1.6, 1.0, 0.5, std::nullopt));
  rows[1].error = "lost";
  EXPECT_THAT(speedups(rows), testing::Each(std::nullopt)) << "without the base there is nothing to compare with";
  EXPECT_THAT(speedups({rows[0]}), testing::ElementsAre(std::nullopt));
}

TEST(Opponents, AreThoseWithAsManyThreadsElseAll) {
  const auto plan = [](const std::string& backend, int threads) { return row("", backend, threads, 1.0).plan; };
  const std::vector<RunPlan> runs{plan("reference", 0), plan("omp", 1),    plan("omp", 2),
                                  plan("opencl", 2),    plan("opencl", 0), plan("opencl", 3)};
  EXPECT_THAT(opponents_of(runs, 3), testing::ElementsAre(2u));
  EXPECT_THAT(opponents_of(runs, 4), testing::ElementsAre(1u, 2u));
  EXPECT_THAT(opponents_of(runs, 5), testing::ElementsAre(1u, 2u)) << "no omp run has three threads";
}

FrameRecord frame(double ms) {
  FrameRecord record;
  record.report.frame_ms = ms;
  return record;
}

TEST(Lead, IsAgainstTheFastestAndPairsEqualFrames) {
  Comparison comparison;
  comparison.rows = {row("omp, 1", "omp", 1, 40.0), row("omp, 2", "omp", 2, 20.0), row("cl", "opencl", 0, 10.0)};
  // Frames differ by far more than the runs do; the ratio of twins does not.
  std::vector<FrameRecord> slow, fast;
  for (int i = 1; i <= 8; ++i) {
    slow.push_back(frame(2.0 * i * i));
    fast.push_back(frame(1.0 * i * i));
  }
  comparison.frames = {slow, slow, fast};
  const auto lead = lead_of(comparison, 2);
  ASSERT_TRUE(lead && lead->interval);
  EXPECT_EQ(lead->against, "omp, 2");
  EXPECT_EQ(lead->ratio, 2.0);
  EXPECT_EQ(lead->interval->low, 2.0);
  EXPECT_EQ(lead->interval->high, 2.0);
  comparison.rows[1].error = "lost";
  EXPECT_EQ(lead_of(comparison, 2)->against, "omp, 1");
  comparison.rows[0].error = "lost";
  EXPECT_FALSE(lead_of(comparison, 2));
}

TEST(Crossover, IsInterpolatedInTheLogarithms) {
  // From half to twice the speed between 1,000 and 4,000: even in the middle of the logarithms, at 2,000.
  const auto crossings = crossings_of(leads({{1000, 0.5}, {4000, 2.0}, {8000, 3.0}}));
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_NEAR(crossings[0].particles, 2000.0, 2000.0 * k_relative);
  EXPECT_TRUE(crossings[0].overtakes && crossings[0].sure);
  EXPECT_EQ(crossings[0].between_low, 1000);
  EXPECT_EQ(crossings[0].between_high, 4000);
  EXPECT_THAT(crossover_verdict(leads({{1000, 0.5}, {4000, 2.0}}), crossings),
              testing::HasSubstr("overtakes OpenMP at about 2,000 particles (between 1,000 and 4,000)"));
}

TEST(Crossover, ThereMayBeNone) {
  const auto verdict = [](const std::vector<Lead>& of) {
    EXPECT_TRUE(crossings_of(of).empty());
    return crossover_verdict(of, {});
  };
  EXPECT_THAT(verdict(leads({{1000, 0.5}, {4000, 0.75}})),
              testing::HasSubstr("does not overtake OpenMP: behind at every size from 1,000 to 4,000"));
  EXPECT_THAT(verdict(leads({{1000, 1.5}, {4000, 1.25}})), testing::HasSubstr("is ahead of OpenMP at every size"));
  EXPECT_THAT(verdict(leads({{1000, 1.0}, {4000, 1.0}})), testing::HasSubstr("is as fast as OpenMP at every size"));
  EXPECT_THAT(verdict(leads({{1000, 0.5}})), testing::HasSubstr("at 1,000 particles, the only size"));
  EXPECT_THAT(verdict({}), testing::HasSubstr("at no size"));
}

TEST(Crossover, ACurveThatGoesBackAndForthCrossesMoreThanOnce) {
  const auto of = leads({{1000, 0.5}, {2000, 2.0}, {4000, 0.5}, {8000, 2.0}});
  const auto crossings = crossings_of(of);
  ASSERT_EQ(crossings.size(), 3u);
  EXPECT_FALSE(crossings[1].overtakes);
  EXPECT_THAT(crossover_verdict(of, crossings), testing::HasSubstr("falls behind OpenMP at about 2,828"));
}

TEST(Crossover, AnEvenSizeIsWhereTheyCross) {
  const auto crossings = crossings_of(leads({{1000, 0.5}, {2000, 1.0}, {4000, 2.0}}));
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_EQ(crossings[0].particles, 2000.0);
  EXPECT_TRUE(crossings_of(leads({{1000, 0.5}, {2000, 1.0}, {4000, 0.5}})).empty()) << "touching is not crossing";
  EXPECT_TRUE(crossings_of(leads({{1000, 1.0}, {2000, 2.0}})).empty());
}

TEST(Crossover, SaysWhereTheNoiseHidesIt) {
  auto of = leads({{1000, 0.99}, {4000, 2.0}});
  of[0].interval = Interval{0.9, 1.1, 0.95};
  const auto crossings = crossings_of(of);
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_FALSE(crossings[0].sure);
  EXPECT_THAT(crossover_verdict(of, crossings), testing::HasSubstr("within the noise"));
  of.pop_back();
  EXPECT_THAT(crossover_verdict(of, {}), testing::HasSubstr("within the noise"));
}

TEST(Budget, APowerLawIsMetExactly) {
  std::vector<CurvePoint> curve;
  for (const double n : {1000.0, 2000.0, 4000.0, 8000.0}) curve.push_back({n, std::pow(n / 1000.0, 4.0 / 3.0)});
  const auto estimate = largest_within(curve, 4.0);
  EXPECT_EQ(estimate.fit, BudgetFit::within);
  const double expected = 1000.0 * std::pow(4.0, 0.75);
  EXPECT_NEAR(estimate.particles, expected, expected * k_relative);
}

TEST(Budget, AllOrNoneOfTheRangeMayFit) {
  const std::vector<CurvePoint> curve{{1000.0, 2.0}, {2000.0, 4.0}};
  EXPECT_EQ(largest_within(curve, 1.9).fit, BudgetFit::none);
  EXPECT_EQ(largest_within(curve, 4.0).fit, BudgetFit::all);
  EXPECT_EQ(largest_within(curve, 4.0).particles, 2000.0);
  EXPECT_EQ(largest_within({}, 4.0).fit, BudgetFit::not_measured);
  EXPECT_EQ(largest_within({{1000.0, 2.0}}, 2.0).fit, BudgetFit::all);
  EXPECT_EQ(largest_within({{1000.0, 2.0}}, 1.0).fit, BudgetFit::none);
}

TEST(Budget, OnACurveThatGoesBackAndForthTheLargestCounts) {
  const std::vector<CurvePoint> curve{{1000.0, 2.0}, {2000.0, 5.0}, {4000.0, 2.0}, {8000.0, 8.0}};
  const auto estimate = largest_within(curve, 4.0);
  EXPECT_EQ(estimate.fit, BudgetFit::within);
  EXPECT_NEAR(estimate.particles, std::sqrt(4000.0 * 8000.0), 8000.0 * k_relative);
  // Flat within the budget, and the first point exactly on it.
  EXPECT_EQ(largest_within({{1000.0, 4.0}, {2000.0, 4.0}, {4000.0, 4.0}}, 4.0).fit, BudgetFit::all);
  EXPECT_EQ(largest_within({{1000.0, 4.0}, {2000.0, 8.0}}, 4.0).particles, 1000.0);
}

}  // namespace
}  // namespace squall::harness
