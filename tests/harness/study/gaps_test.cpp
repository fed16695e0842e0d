#include "harness/study/gaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "harness/study/observables.h"
#include "harness/study/study_scenes.h"

namespace squall::harness {
namespace {

using testing::HasSubstr;

std::string refusal(const Scene& scene, int frames) {
  try {
    require_water(scene, frames);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StudyWater, ASceneWithoutAParticleIsRefused) {
  Scene scene = falling_column();
  EXPECT_EQ(refusal(scene, 1), "");
  scene.blocks.clear();
  EXPECT_THAT(refusal(scene, 30), HasSubstr("no particle in the 1 s"));
  for (const auto& observable : study_observables()) EXPECT_THAT(refusal(scene, 30), HasSubstr(observable.name));
  Scene::Rain rain;
  rain.area_min_m = {0.1, 0.1};
  rain.area_max_m = {0.3, 0.3};
  rain.particles_per_s = 30.0;  // one a frame
  rain.start_s = 0.5;           // frame 15
  rain.max_particles = 5;
  scene.rains.push_back(rain);
  EXPECT_NE(refusal(scene, 16), "") << "the first drop is due when the frame after that begins";
  EXPECT_EQ(refusal(scene, 17), "");
}

/// A column that falls from `height` layers of 0.1 m above the floor.
StudySubjects falling_from(int height) {
  StudySubjects subjects = small_study(Pressure::wcsph, {StudyAxis::step});
  subjects.scene.container.max_m.y() = 4.0;
  for (auto* corner : {&subjects.scene.blocks[0].min_m, &subjects.scene.blocks[0].max_m})
    corner->y() += height * subjects.scene.fluid.spacing_m;
  return subjects;
}

TEST(StudyGaps, AnObservableThatNoRunHasIsLeftOutAndSaid) {
  const StudySubjects subjects = falling_from(20);
  StudyRecords records;
  const StudyRuns runs = run_study(subjects, {}, make_any, records);
  const StudyFindings findings = find_out(runs, {});
  for (const auto& point : findings.points) {
    EXPECT_TRUE(point.total_errors.contains(k_combined_error));
    EXPECT_FALSE(point.total_errors.contains("front_m"));
    EXPECT_EQ(point.reason, "");
  }
  EXPECT_FALSE(findings.front.empty());
  ASSERT_EQ(findings.gaps.size(), 2u);
  EXPECT_THAT(findings.gaps[0], HasSubstr("front_m has no value at any output time (it needs a free particle in the"));
  EXPECT_EQ(findings.gaps[1], "the combined error is of x_cm_m, y_cm_m, energy_j here");
  const StudyFindings of_front = find_out(runs, {"front_m", {}, {}});
  EXPECT_TRUE(of_front.front.empty());
  for (const auto& point : of_front.points) EXPECT_THAT(point.reason, HasSubstr("no front_m error"));
}

/// 0.2 s are six frames; from one layer up it is in the lowest two before the fourth.
TEST(StudyGaps, WhatIsDefinedLaterIsComparedFromThenOn) {
  const StudySubjects subjects = falling_from(3);
  StudyRecords records;
  const StudyRuns runs = run_study(subjects, {}, make_any, records);
  const Record& record = *runs.records[0].front();
  ASSERT_TRUE(std::isnan(record.values.at("front_m").front()));
  ASSERT_FALSE(std::isnan(record.values.at("front_m").back()));
  const StudyFindings findings = find_out(runs, {});
  for (const auto& point : findings.points) EXPECT_TRUE(point.total_errors.contains("front_m")) << point.reason;
  ASSERT_EQ(findings.gaps.size(), 1u);
  EXPECT_THAT(findings.gaps[0], HasSubstr("of 6 output times in the run that has it least"));
}

TEST(StudyGaps, ASettingThatLacksWhatTheReferenceHasIsNotRanked) {
  const StudySubjects subjects = falling_from(0);
  StudyRecords records;
  StudyRuns runs = run_study(subjects, {}, make_any, records);
  Record lacking = *runs.records[0].front();
  for (double& value : lacking.values["front_m"]) value = std::nan("");
  runs.records[0] = {&lacking};
  const StudyFindings findings = find_out(runs, {});
  EXPECT_EQ(findings.points[0].status, PointStatus::fine);
  EXPECT_FALSE(findings.points[0].on_front);
  EXPECT_THAT(findings.points[0].reason, HasSubstr("no combined error: front_m has no value at any output time here"));
  EXPECT_FALSE(findings.front.empty()) << "the others are";
}

}  // namespace
}  // namespace squall::harness
