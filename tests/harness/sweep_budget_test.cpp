#include "harness/sweep_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "harness/fake_solver.h"

namespace squall::harness {
namespace {

/// A machine whose frame time is known: N/1000 ms, and above 3,000 particles more by `jump` ms. Scenes scale to
/// multiples of `grain` alone and hold `rain` times what has fallen.
struct Machine {
  double jump = 0.0;
  std::int64_t grain = 1, rain = 1;
  std::vector<std::int64_t> measured = {};

  SweepPoint point(std::int64_t scene_particles) const {
    SweepPoint result;
    result.size.scene_particles = scene_particles;
    result.row.plan = short_plan("omp", "omp");
    result.row.frames = 6;
    result.row.particles = scene_particles / rain;
    const auto n = static_cast<double>(result.row.particles);
    result.row.frame_ms.median = n / 1000.0 + (n > 3000.0 ? jump : 0.0);
    return result;
  }
  BudgetProbe probe() {
    BudgetProbe result;
    result.real_size = [this](std::int64_t n) {
      const std::int64_t layers = std::llround(static_cast<double>(n) / static_cast<double>(grain));
      return grain * std::max<std::int64_t>(1, layers);
    };
    result.measure = [this](std::int64_t n) {
      measured.push_back(n);
      return std::optional(point(n));
    };
    return result;
  }
};

TEST(BudgetSearch, MeasuresWhatItInterpolated) {
  Machine machine;
  const auto result =
      search_largest("omp", {machine.point(1000), machine.point(2000), machine.point(8000)}, 4.0, machine.probe());
  EXPECT_EQ(result.fit, BudgetFit::within);
  EXPECT_THAT(machine.measured, testing::ElementsAre(4000));
  ASSERT_TRUE(result.largest);
  EXPECT_EQ(result.largest->row.particles, 4000);
  EXPECT_THAT(result.verdict, testing::HasSubstr("4,000 particles: 4 ms measured"));
}

TEST(BudgetSearch, GoesDownWhereTheEstimateWasTooHigh) {
  Machine machine;
  machine.jump = 2.0;  // a cache that is full: nothing above 3,000 keeps 4 ms
  const auto result = search_largest("omp", {machine.point(1000), machine.point(8000)}, 4.0, machine.probe());
  ASSERT_TRUE(result.largest);
  EXPECT_LE(result.largest->row.frame_ms.median, 4.0);
  EXPECT_GT(result.largest->row.particles, 1000);
  EXPECT_LE(result.tried.size(), 4u);
  EXPECT_GT(result.tried.front().row.frame_ms.median, 4.0) << "else this tests nothing";
  EXPECT_THAT(result.verdict, testing::HasSubstr(" took "));
}

TEST(BudgetSearch, NeverReportsWhatWasNotMeasured) {
  Machine machine;
  machine.grain = 1000;
  // 3,000 and 4,000 are neighbours: there is nothing to measure between them.
  const auto result = search_largest("omp", {machine.point(3000), machine.point(4000)}, 3.6, machine.probe());
  EXPECT_TRUE(machine.measured.empty());
  ASSERT_TRUE(result.largest && result.estimate_particles);
  EXPECT_EQ(result.largest->row.particles, 3000);
  EXPECT_GT(*result.estimate_particles, 3500.0);
}

TEST(BudgetSearch, WithRainItAsksForTheWholeScene) {
  Machine machine;
  machine.rain = 10;
  search_largest("omp", {machine.point(10000), machine.point(80000)}, 4.0, machine.probe());
  ASSERT_EQ(machine.measured.size(), 1u);
  EXPECT_NEAR(static_cast<double>(machine.measured.front()), 40000.0, 1.0);
}

TEST(BudgetSearch, NothingIsRunWhereNothingIsToBeFound) {
  Machine machine;
  const std::vector<SweepPoint> points{machine.point(1000), machine.point(2000)};
  const auto none = search_largest("omp", points, 0.5, machine.probe());
  EXPECT_EQ(none.fit, BudgetFit::none);
  EXPECT_FALSE(none.largest);
  EXPECT_THAT(none.verdict, testing::HasSubstr("no size fits: 1 ms at the smallest one, 1,000"));
  const auto all = search_largest("omp", points, 5.0, machine.probe());
  EXPECT_EQ(all.fit, BudgetFit::all);
  EXPECT_EQ(all.largest->row.particles, 2000);
  EXPECT_THAT(all.verdict, testing::HasSubstr("every size fits: 2 ms at the largest one, 2,000"));
  const auto other = search_largest("opencl", points, 5.0, machine.probe());
  EXPECT_EQ(other.fit, BudgetFit::not_measured);
  EXPECT_FALSE(other.largest);
  EXPECT_TRUE(machine.measured.empty());
}

TEST(BudgetSearch, ARunThatFailsIsNoSizeThatFits) {
  Machine machine;
  auto probe = machine.probe();
  probe.measure = [&](std::int64_t n) {
    auto point = machine.point(n);
    point.row.error = "a particle is lost";
    point.row.frame_ms.median = 0.0;
    return std::optional(point);
  };
  const auto result = search_largest("omp", {machine.point(1000), machine.point(8000)}, 4.0, probe);
  EXPECT_EQ(result.largest->row.particles, 1000);
  EXPECT_EQ(result.tried.size(), 1u);
  EXPECT_THAT(result.verdict, testing::HasSubstr("a particle is lost"));
}

TEST(BudgetSearch, SaysThatItWasInterrupted) {
  Machine machine;
  auto probe = machine.probe();
  probe.measure = [](std::int64_t) { return std::optional<SweepPoint>(); };
  const auto result = search_largest("omp", {machine.point(1000), machine.point(8000)}, 4.0, probe);
  EXPECT_EQ(result.largest->row.particles, 1000);
  EXPECT_THAT(result.verdict, testing::HasSubstr("interrupted"));
}

}  // namespace
}  // namespace squall::harness
