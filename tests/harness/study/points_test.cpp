#include "harness/study/points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/frame_plan.h"
#include "harness/study/study_scenes.h"

namespace squall::harness {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const StudyPoints& points) {
  std::vector<std::string> names;
  for (const auto& point : points.points) names.push_back(point.name);
  return names;
}

TEST(StudyPoints, OneThingIsChangedAtATime) {
  StudySubjects subjects = small_study(Pressure::dfsph, study_axes());
  subjects.plans.push_back(subjects.plans.front());
  subjects.plans.back().settings.precision = Precision::single_precision;
  subjects.plans.back().label = "reference, single";
  const StudyPoints points = make_points(subjects);
  EXPECT_THAT(names_of(points), ElementsAre("dfsph", "dfsph, step x2", "dfsph, step x0.5", "dfsph, tolerance x10",
                                            "dfsph, reference, single", "dfsph, dx 200 mm", "dfsph, H/dx 1.7"));
  EXPECT_EQ(points.models.size(), 3u);
  EXPECT_THAT(points.points[0].overrides, ElementsAre());
  EXPECT_THAT(points.points[1].overrides, ElementsAre("[solver] cfl = 0.8", "[solver] dt_max_s = 0.01"));
  EXPECT_THAT(points.points[3].overrides,
              ElementsAre("[solver] density_tolerance = 0.01", "[solver] divergence_tolerance = 0.01"));
  EXPECT_THAT(points.points[4].overrides, ElementsAre());
  EXPECT_THAT(points.points[5].overrides, ElementsAre("[fluid] spacing_m = 0.2"));
  EXPECT_THAT(points.points[6].overrides, ElementsAre("[fluid] support_ratio = 1.7"));
}

TEST(StudyPoints, OnlyWhatIsAskedForIsChanged) {
  const auto points = make_points(small_study(Pressure::wcsph, {StudyAxis::tolerance}));
  EXPECT_THAT(names_of(points), ElementsAre("wcsph")) << "wcsph has no tolerance";
}

TEST(StudyPoints, WhatASceneCannotBeChangedToIsLeftOut) {
  StudySubjects subjects = small_study(Pressure::wcsph, {StudyAxis::step});
  subjects.ranges.step = {1000.0};  // cfl 400
  const StudyPoints points = make_points(subjects);
  EXPECT_THAT(names_of(points), ElementsAre("wcsph"));
  ASSERT_EQ(points.notes.size(), 1u);
  EXPECT_THAT(points.notes[0], HasSubstr("wcsph, step x1000 is left out"));
  subjects.pressures = {Pressure::dfsph};
  subjects.scene.fluid.support_ratio = 2.4;
  EXPECT_TRUE(make_points(subjects).points.empty());
  EXPECT_THAT(make_points(subjects).notes.at(0), HasSubstr("dfsph is left out"));
}

TEST(StudyPoints, AReferenceHasAnEighthOfTheFinestStep) {
  const StudySubjects subjects = small_study(Pressure::dfsph, {StudyAxis::step, StudyAxis::tolerance});
  const StudyPoints points = make_points(subjects);
  const StudyRun run = reference_run(subjects, points, 0, 1.6e-3, 20);
  EXPECT_DOUBLE_EQ(run.scene.solver.dt_max_s, 2e-4);
  EXPECT_DOUBLE_EQ(run.scene.solver.cfl, 0.4 * 0.5 / 8.0);
  EXPECT_DOUBLE_EQ(run.scene.solver.density_tolerance, 1e-7);
  EXPECT_EQ(run.plan.settings.precision, Precision::double_precision);
  EXPECT_EQ(run.every, 1);
  EXPECT_EQ(run.plan.frames, 6);
}

TEST(StudyPoints, AReferenceOfManyStepsHasShorterFrames) {
  const StudySubjects subjects = small_study(Pressure::wcsph, {});
  const StudyPoints points = make_points(subjects);
  const StudyRun run = reference_run(subjects, points, 0, 1.0 / (30.0 * 120.0), 120);
  EXPECT_EQ(run.every, 3) << "8 * 120 sub-steps, at most 400 a frame";
  EXPECT_DOUBLE_EQ(run.scene.time.frame_rate_hz, 90.0);
  EXPECT_EQ(run.plan.frames, 18);
  EXPECT_LE(1.0 / (run.scene.time.frame_rate_hz * run.scene.solver.dt_max_s), 400.0);
}

TEST(StudyPoints, SmoothingStaysTheSameViscosity) {
  StudySubjects subjects = small_study(Pressure::dfsph, {StudyAxis::step});
  subjects.scene.solver.xsph = 0.1;
  const StudyPoints points = make_points(subjects);
  const double viscosity = smoothing_viscosity(subjects.scene, Pressure::dfsph);
  ASSERT_GT(viscosity, 0.0);
  const double rounding = 1e-14 * viscosity;
  for (const auto& point : points.points)
    EXPECT_NEAR(smoothing_viscosity(point.run.scene, Pressure::dfsph), viscosity, rounding) << point.name;
  const StudyRun reference = reference_run(subjects, points, 0, 1.0 / (30.0 * 20.0), 20);
  EXPECT_NEAR(smoothing_viscosity(reference.scene, Pressure::dfsph), viscosity, rounding);
}

// Steps finer than a frame has room for are left out with the reason, and so is what stands beside them.
TEST(StudyPoints, WhatNoFrameHasRoomForIsLeftOut) {
  StudySubjects subjects = small_study(Pressure::dfsph, {StudyAxis::step});
  subjects.scene.fluid.viscosity_m2_s = 1e9;
  const StudyPoints points = make_points(subjects);
  EXPECT_TRUE(points.points.empty());
  ASSERT_FALSE(points.notes.empty());
  EXPECT_NE(points.notes[0].find("left out: viscosity_m2_s"), std::string::npos) << points.notes[0];
  for (std::size_t model = 0; model < points.models.size(); ++model)
    EXPECT_TRUE(noise_runs(subjects, points, model).empty());
}

TEST(StudyPoints, WithoutParticlesAtTheStartNothingIsPerturbed) {
  StudySubjects subjects = small_study(Pressure::wcsph, {});
  EXPECT_EQ(noise_runs(subjects, make_points(subjects), 0).size(), 3u);
  subjects.scene.blocks.clear();
  EXPECT_TRUE(noise_runs(subjects, make_points(subjects), 0).empty());
}

}  // namespace
}  // namespace squall::harness
