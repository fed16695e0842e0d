#include "harness/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/fake_solver.h"

namespace squall::harness {
namespace {

Particles two_particles() {
  Particles particles;
  particles.add(7, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  particles.add(3, {0.0, 1.0, 0.0}, {0.0, 2.0, 0.0});
  return particles;
}

TEST(Difference, IsNothingForTheSameParticlesInAnyOrder) {
  Particles other;
  other.add(3, {0.0, 1.0, 0.0}, {0.0, 2.0, 0.0});
  other.add(7, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  EXPECT_FALSE(difference_between(two_particles(), other, 0.5));
}

TEST(Difference, NamesTheLowestParticleAndTheLargestErrors) {
  Particles other = two_particles();
  other.positions[0].z() = 0.25;
  other.velocities[1].x() = -3.0;
  const auto difference = difference_between(two_particles(), other, 0.5);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->particle, 3u);
  EXPECT_EQ(difference->max_position_error_dx, 0.5);
  EXPECT_EQ(difference->max_velocity_error, 3.0);
}

TEST(Difference, ToAMissingOrBrokenParticleIsInfinite) {
  Particles fewer;
  fewer.add(3, {0.0, 1.0, 0.0}, {0.0, 2.0, 0.0});
  const auto missing = difference_between(fewer, two_particles(), 0.5);
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->particle, 7u);
  EXPECT_TRUE(std::isinf(missing->max_position_error_dx));
  Particles broken = two_particles();
  broken.positions[1].x() = std::nan("");
  const auto difference = difference_between(two_particles(), broken, 0.5);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->particle, 3u);
  EXPECT_TRUE(std::isinf(difference->max_position_error_dx));
}

/// Steps fakes in lock-step and returns what the check says.
Agreement agreement_of(std::vector<std::pair<RunPlan, Faults>> what) {
  std::vector<std::unique_ptr<Run>> runs;
  std::vector<const Run*> views;
  for (const auto& [plan, faults] : what) {
    runs.push_back(std::make_unique<Run>(make_fake(plan, faults), plan));
    views.push_back(runs.back().get());
  }
  AgreementCheck check;
  while (std::any_of(runs.begin(), runs.end(), [](const auto& run) { return !run->done(); })) {
    for (auto& run : runs) run->step();
    check.after_round(views);
  }
  return check.result();
}

Faults differing_from(int frame) {
  Faults faults;
  faults.differs_from = frame;
  return faults;
}

TEST(Agreement, SameBitsAfterEveryFrame) {
  const Agreement agreement = agreement_of({{short_plan("a"), {}}, {short_plan("b"), {}}, {short_plan("c"), {}}});
  ASSERT_TRUE(agreement.bitwise);
  EXPECT_TRUE(*agreement.bitwise);
  EXPECT_TRUE(agreement.agree);
  EXPECT_FALSE(agreement.first_difference_frame);
  EXPECT_EQ(agreement.verdict, "same bits in 3 runs after each of 8 frames");
}

TEST(Agreement, FirstDifferenceIsNamed) {
  const Agreement agreement =
      agreement_of({{short_plan("a"), {}}, {short_plan("b"), differing_from(4)}, {short_plan("c"), differing_from(6)}});
  ASSERT_TRUE(agreement.bitwise);
  EXPECT_FALSE(*agreement.bitwise);
  EXPECT_FALSE(agreement.agree);
  EXPECT_EQ(agreement.first_difference_frame, 4u);
  ASSERT_TRUE(agreement.difference);
  EXPECT_EQ(agreement.difference->particle, 5u);
  // 0.01 m at a spacing of 0.1 m, found as a difference of coordinates below 1 m.
  EXPECT_NEAR(agreement.difference->max_position_error_dx, 0.1, 10.0 * std::numeric_limits<double>::epsilon());
  EXPECT_NE(agreement.verdict.find("a and b differ first after frame 4, particle 5"), std::string::npos)
      << agreement.verdict;
}

Faults losing_at(int frame) {
  Faults faults;
  faults.loses_at = frame;
  return faults;
}

TEST(Agreement, WhenAllFailOnlyComparedFramesCount) {
  const Agreement agreement = agreement_of({{short_plan("a"), losing_at(1)}, {short_plan("b"), losing_at(1)}});
  EXPECT_EQ(agreement.bitwise, true);
  EXPECT_TRUE(agreement.agree);
  EXPECT_EQ(agreement.verdict, "same bits in 2 runs after each of 2 frames; all failed and stopped after 2 frames");
}

TEST(Agreement, TheFrameInWhichAllFailIsCompared) {
  Faults both = losing_at(0);
  both.differs_from = 0;
  const Agreement agreement = agreement_of({{short_plan("a"), losing_at(0)}, {short_plan("b"), both}});
  EXPECT_EQ(agreement.bitwise, false);
  EXPECT_FALSE(agreement.agree);
  EXPECT_EQ(agreement.first_difference_frame, 0u);
}

TEST(Agreement, ARunThatFailsAloneDisagrees) {
  const Agreement agreement =
      agreement_of({{short_plan("a"), {}}, {short_plan("b"), losing_at(4)}, {short_plan("c"), {}}});
  EXPECT_EQ(agreement.bitwise, false);
  EXPECT_FALSE(agreement.agree);
  EXPECT_EQ(agreement.first_difference_frame, 4u);
  EXPECT_EQ(agreement.verdict,
            "same bits in 3 runs after each of 8 frames; b failed in frame 4 where a did not; failed and stopped: b "
            "after 5 frames");
}

TEST(Agreement, BitsOfTheFrameInWhichOneFailsAreCompared) {
  Faults faults = losing_at(4);
  faults.differs_from = 4;
  const Agreement agreement = agreement_of({{short_plan("a"), {}}, {short_plan("b"), faults}});
  EXPECT_EQ(agreement.first_difference_frame, 4u);
  ASSERT_TRUE(agreement.difference);
  EXPECT_EQ(agreement.difference->particle, 5u);
  EXPECT_NE(agreement.verdict.find("a and b differ first after frame 4"), std::string::npos) << agreement.verdict;
}

TEST(Agreement, AFailedDeviceIsNamedAndComparedUntilThen) {
  Faults faults;
  faults.device_fails_at = 3;
  const Agreement agreement = agreement_of({{short_plan("a"), {}}, {short_plan("b"), faults}});
  EXPECT_EQ(agreement.bitwise, true);
  EXPECT_TRUE(agreement.agree);
  EXPECT_EQ(agreement.verdict, "same bits in 2 runs after each of 3 frames; failed and stopped: b after 3 frames");
}

TEST(Agreement, DevicesThatFailAtOnceLeaveNothingToCompare) {
  Faults faults;
  faults.device_fails_at = 0;
  const Agreement agreement = agreement_of({{short_plan("a"), faults}, {short_plan("b"), faults}});
  EXPECT_FALSE(agreement.bitwise);
  EXPECT_NE(agreement.verdict.find("all failed and stopped after 0 frames"), std::string::npos) << agreement.verdict;
}

RunPlan double_plan(const std::string& label) {
  RunPlan plan = short_plan(label);
  plan.settings.precision = Precision::double_precision;
  return plan;
}

TEST(Agreement, TheReferenceTakesNoPartAndPrecisionsAreNotComparedWithEachOther) {
  const Agreement agreement =
      agreement_of({{short_plan("a"), {}}, {short_plan("r", "reference"), differing_from(0)}, {double_plan("d"), {}}});
  EXPECT_FALSE(agreement.bitwise);
  EXPECT_TRUE(agreement.agree);
}

TEST(Agreement, RunsInDoublePrecisionAreComparedAmongThemselves) {
  const Agreement alone = agreement_of({{double_plan("d"), {}}, {double_plan("e"), {}}});
  EXPECT_EQ(alone.bitwise, true);
  EXPECT_EQ(alone.verdict, "same bits in 2 double-precision runs after each of 8 frames");
  const Agreement beside =
      agreement_of({{short_plan("a"), {}}, {double_plan("d"), {}}, {short_plan("b"), {}}, {double_plan("e"), {}}});
  EXPECT_EQ(beside.bitwise, true);
  EXPECT_EQ(beside.verdict,
            "same bits in 2 runs after each of 8 frames, and in 2 double-precision runs after each of 8 frames");
  const Agreement differing = agreement_of(
      {{short_plan("a"), {}}, {double_plan("d"), {}}, {short_plan("b"), {}}, {double_plan("e"), differing_from(3)}});
  EXPECT_EQ(differing.bitwise, false);
  EXPECT_FALSE(differing.agree);
  EXPECT_EQ(differing.first_difference_frame, 3u);
  EXPECT_NE(differing.verdict.find("d and e differ first after frame 3"), std::string::npos) << differing.verdict;
}

TEST(Agreement, DevicesThatPromiseNoBitsAreHeldToATolerance) {
  RunPlan loose = short_plan("loose");
  loose.strict = false;
  const Agreement late = agreement_of({{short_plan("a"), {}}, {loose, differing_from(3)}});
  EXPECT_TRUE(late.agree) << late.verdict;
  EXPECT_FALSE(late.bitwise);
  const Agreement early = agreement_of({{short_plan("a"), {}}, {loose, differing_from(0)}});
  EXPECT_FALSE(early.agree);
  EXPECT_NE(early.verdict.find("loose is 0.1 dx away from a"), std::string::npos) << early.verdict;
}

TEST(Agreement, ToleranceGrowsWithStepsAndCoordinates) {
  Scene scene = small_scene();
  EXPECT_DOUBLE_EQ(rounding_tolerance_dx(scene, 10, Precision::single_precision),
                   16.0 * 10.0 * 8.0 * static_cast<double>(std::numeric_limits<float>::epsilon()));
  EXPECT_DOUBLE_EQ(rounding_tolerance_dx(scene, 10, Precision::double_precision),
                   16.0 * 10.0 * 8.0 * std::numeric_limits<double>::epsilon());
}

}  // namespace
}  // namespace squall::harness
