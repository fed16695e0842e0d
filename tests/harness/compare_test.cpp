#include "harness/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "harness/fake_solver.h"

namespace squall::harness {
namespace {

std::vector<RunPlan> four_plans() {
  return {short_plan("omp", "omp"), short_plan("none", "opencl", Readback::none),
          short_plan("blocking", "opencl", Readback::blocking), short_plan("mapped", "opencl", Readback::mapped)};
}

TEST(Order, EveryRoundHasEveryRunOnceAndKeepsDevicesTogether) {
  const auto plans = four_plans();
  for (int round = 0; round < 12; ++round) {
    const auto order = order_of_round(plans, round);
    EXPECT_THAT(order, testing::UnorderedElementsAre(0u, 1u, 2u, 3u));
    EXPECT_TRUE(order.front() == 0 || order.back() == 0) << "omp splits the OpenCL runs in round " << round;
  }
}

TEST(Order, NoRunOfADeviceIsAlwaysFirst) {
  const auto plans = four_plans();
  std::map<std::size_t, int> first_of_opencl;
  for (int round = 0; round < 12; ++round) {
    const auto order = order_of_round(plans, round);
    ++first_of_opencl[*std::find_if(order.begin(), order.end(), [](auto run) { return run != 0; })];
  }
  EXPECT_THAT(first_of_opencl,
              testing::UnorderedElementsAre(testing::Pair(1u, 4), testing::Pair(2u, 4), testing::Pair(3u, 4)));
}

TEST(Compare, GivesARowPerPlanInTheirOrder) {
  const auto plans = four_plans();
  int rounds = 0;
  const auto result = compare([](const RunPlan& plan) { return make_fake(plan); }, plans,
                              [&](int done, int total) {
                                EXPECT_EQ(done, ++rounds);
                                EXPECT_EQ(total, 8);
                                return true;
                              });
  ASSERT_EQ(result.rows.size(), 4u);
  EXPECT_EQ(rounds, 8);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(result.rows[i].plan.label, plans[i].label);
    EXPECT_EQ(result.rows[i].frames, 6);
    EXPECT_EQ(result.frames[i].size(), 6u);
    EXPECT_EQ(result.rows[i].phase_ms.count("density"), 1u);
  }
  EXPECT_TRUE(result.agreement.agree);
}

TEST(Compare, ExposedReadBackNeedsTheSameRunWithoutReadBack) {
  const auto result = compare([](const RunPlan& plan) { return make_fake(plan); }, four_plans());
  EXPECT_FALSE(result.rows[0].exposed_readback_ms) << "omp has no run without read-back to compare with";
  EXPECT_FALSE(result.rows[1].exposed_readback_ms);
  ASSERT_TRUE(result.rows[2].exposed_readback_ms);
  ASSERT_TRUE(result.rows[2].exposed_readback_interval_ms);
  std::vector<double> differences;
  for (std::size_t f = 0; f < 6; ++f)
    differences.push_back(result.frames[2][f].report.frame_ms - result.frames[1][f].report.frame_ms);
  EXPECT_EQ(*result.rows[2].exposed_readback_ms, median(differences));
}

TEST(Compare, ADeviceThatFailsLeavesTheOthersAlone) {
  const auto plans = four_plans();
  const auto result = compare(
      [](const RunPlan& plan) -> std::unique_ptr<Solver> {
        if (plan.label == "none") throw DeviceError("no such device");
        Faults faults;
        if (plan.label == "mapped") faults.device_fails_at = 5;
        return make_fake(plan, faults);
      },
      plans);
  EXPECT_EQ(result.rows[0].error, "");
  EXPECT_EQ(result.rows[0].frames, 6);
  EXPECT_EQ(result.rows[1].error, "no such device");
  EXPECT_TRUE(result.rows[1].device_failed);
  EXPECT_EQ(result.rows[1].solver.device, "") << "a device that never started has no name";
  EXPECT_EQ(result.rows[2].error, "");
  EXPECT_FALSE(result.rows[2].exposed_readback_ms);
  EXPECT_TRUE(result.rows[3].device_failed);
}

TEST(Compare, ErrorsAgainstTheReferenceAreInEveryRow) {
  const std::vector<RunPlan> plans{short_plan("reference", "reference"), short_plan("omp", "omp")};
  const auto result = compare(
      [](const RunPlan& plan) {
        Faults faults;
        if (plan.label == "omp") faults.differs_from = 6;
        return make_fake(plan, faults);
      },
      plans);
  ASSERT_TRUE(result.rows[1].position_error_dx);
  EXPECT_NEAR(*result.rows[1].position_error_dx, 0.1, 10.0 * std::numeric_limits<double>::epsilon());
  EXPECT_EQ(result.rows[0].position_error_dx, result.rows[1].position_error_dx);
  EXPECT_TRUE(result.agreement.agree);
}

TEST(Compare, StopsWhenAsked) {
  const auto result = compare([](const RunPlan& plan) { return make_fake(plan); }, four_plans(),
                              [](int done, int) { return done < 4; });
  EXPECT_EQ(result.rows[0].frames, 2);
}

TEST(Compare, RefusesNothingAndUnlikePlans) {
  const auto make = [](const RunPlan& plan) { return make_fake(plan); };
  EXPECT_THROW(compare(make, {}), InputError);
  auto plans = four_plans();
  plans[1].frames = 7;
  EXPECT_THROW(compare(make, plans), InputError);
}

}  // namespace
}  // namespace squall::harness
