#include "harness/validation/check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::harness {
namespace {

/// x_cm_m = f(t) every 0.01 s for two seconds.
template <class Function>
TimeSeries series_of(Function f) {
  TimeSeries series;
  series.columns.push_back({"x_cm_m", "m", {}, {}, false});
  for (int i = 0; i <= 200; ++i) series.columns[0].add(0.01 * i, f(0.01 * i));
  return series;
}

Check check_against(const Expectation& expected, Measure measure, double tolerance) {
  Check check;
  check.name = check.quantity = "x_cm_m";
  check.expected = expected;
  check.measure = measure;
  check.tolerance = tolerance;
  return check;
}

Expectation constant(double value) {
  Expectation expected;
  expected.value = value;
  return expected;
}

const Scene k_scene = test::empty_tank();  // dx = 0.05 m

TEST(Judge, LargestDifferencePassesAtTheToleranceAndFailsAbove) {
  const auto series = series_of([](double t) { return t == 1.0 ? 3.25 : 3.0; });
  Check check = check_against(constant(3.0), Measure::max, 0.25);
  EXPECT_TRUE(judge(check, k_scene, series).passed);
  EXPECT_EQ(judge(check, k_scene, series).worst.time_s, 1.0);
  check.tolerance = 0.2;
  EXPECT_FALSE(judge(check, k_scene, series).passed);
  check.tolerance_dx = 1.0;  // and a spacing of 0.05 m
  EXPECT_TRUE(judge(check, k_scene, series).passed);
  check.to_s = 0.9;
  EXPECT_EQ(judge(check, k_scene, series).error, 0.0);
}

TEST(Judge, ScalesErrors) {
  const auto series = series_of([](double) { return 3.3; });
  Check check = check_against(constant(3.0), Measure::rms, 0.1);
  EXPECT_NEAR(judge(check, k_scene, series).error, 0.3, 1e-12);
  check.relative = true;
  EXPECT_NEAR(judge(check, k_scene, series).error, 0.1, 1e-12);
  check.relative = false;
  check.scale = 30.0;
  EXPECT_NEAR(judge(check, k_scene, series).error, 0.01, 1e-12);
  check.tolerance = 0.0;
  check.tolerance_dx = 3.0;
  EXPECT_NEAR(judge(check, k_scene, series).tolerance, 0.15 / 30.0, 1e-15);
}

TEST(Judge, FindsTheShiftInTime) {
  const auto series = series_of([](double t) { return std::sin(t); });
  Expectation late;
  for (const double t : {0.3, 0.6, 0.9, 1.2}) late.points.push_back({t, std::sin(t - 0.07), {}, {}});
  Check check = check_against(late, Measure::rms, 1e-3);
  EXPECT_FALSE(judge(check, k_scene, series).passed);
  check.largest_shift_s = 0.2;
  const Finding found = judge(check, k_scene, series);
  ASSERT_TRUE(found.shift_s);
  // The scan ends with steps of 0.2 (2/100)^2/100 s; between samples the sine is a chord, off by up to 0.01^2/8.
  EXPECT_NEAR(*found.shift_s, -0.07, 1e-4);
  EXPECT_LT(found.error, 2e-5);
}

TEST(Judge, MeasuresPeriodsSlopesAndLines) {
  const auto wave = series_of([](double t) { return 0.7 + std::cos(2 * test::k_pi * t / 0.4 + 1.0); });
  const Finding period = judge(check_against(constant(0.4), Measure::period, 1e-3), k_scene, wave);
  EXPECT_NEAR(period.worst.measured, 0.4, 1e-4);  // crossings on chords of a tenth of a radian
  EXPECT_TRUE(period.passed);

  auto two = series_of([](double t) { return 0.1 + 0.9 * t + (t == 1.0 ? 0.02 : 0.0); });
  two.columns.push_back(two.columns[0]);
  two.columns[1].name = "y_cm_m";
  for (std::size_t i = 0; i < two.columns[1].value.size(); ++i) two.columns[1].value[i] = 0.01 * static_cast<double>(i);
  Expectation like;
  like.like = "y_cm_m";
  EXPECT_NEAR(judge(check_against(like, Measure::slope, 0.2), k_scene, two).error, 0.1, 1e-9);
  EXPECT_NEAR(judge(check_against(like, Measure::line, 0.2), k_scene, two).error, 0.02, 2e-4);
}

TEST(Judge, BoundsAreOneSided) {
  const auto series = series_of([](double t) { return -t; });
  Expectation start;
  start.formula = "start";
  EXPECT_EQ(judge(check_against(start, Measure::below, 0.0), k_scene, series).error, 0.0);
  EXPECT_NEAR(judge(check_against(start, Measure::above, 0.0), k_scene, series).error, 2.0, 1e-12);
  EXPECT_NEAR(judge(check_against(start, Measure::mean, 0.0), k_scene, series).error, 1.0, 1e-12);
}

TEST(Judge, SaysWhatItCannotJudge) {
  const auto series = series_of([](double t) { return t; });
  Expectation late;
  late.points = {{1.0, 1.0, {}, {}}, {7.0, 7.0, {}, {}}};
  const Finding beyond = judge(check_against(late, Measure::max, 1.0), k_scene, series);
  EXPECT_FALSE(beyond.passed);
  EXPECT_NE(beyond.problem.find("lengthen duration_s"), std::string::npos);
  Check nowhere = check_against(constant(0.0), Measure::max, 1.0);
  nowhere.from_s = 3.0;
  EXPECT_FALSE(judge(nowhere, k_scene, series).passed);
  EXPECT_TRUE(judge(nowhere, k_scene, series).lacks_values);
  Check zero = check_against(constant(0.0), Measure::max, 1.0);
  zero.relative = true;
  EXPECT_NE(judge(zero, k_scene, series).problem.find("relative error"), std::string::npos);
  EXPECT_NE(judge(check_against(constant(1.0), Measure::period, 1.0), k_scene, series).problem.find("one period"),
            std::string::npos);
}

/// x_cm_m = 3 m, but without a value from 0.5 s to 0.6 s.
TimeSeries series_with_gap() {
  auto series = series_of([](double t) { return t > 0.495 && t < 0.605 ? std::nan("") : 3.0; });
  series.columns[0].needs = "a particle";
  return series;
}

TEST(Judge, WhatHasNoValuePassesNothing) {
  const auto series = series_with_gap();
  Expectation points;
  points.points = {{0.2, 3.0, {}, {}}, {0.555, 3.0, {}, {}}, {1.0, 3.0, {}, {}}};
  Expectation start;
  start.formula = "start";
  for (const auto& expected : {constant(3.0), points, start})
    for (const Measure measure : {Measure::max, Measure::rms, Measure::mean, Measure::below, Measure::above}) {
      const Finding found = judge(check_against(expected, measure, 1.0), k_scene, series);
      EXPECT_FALSE(found.passed) << to_string(measure);
      EXPECT_TRUE(found.lacks_values);
      EXPECT_TRUE(std::isnan(found.error));
      EXPECT_TRUE(std::isnan(found.worst.measured));
      EXPECT_NE(found.problem.find("x_cm_m has no value at"), std::string::npos) << found.problem;
      EXPECT_NE(found.problem.find("a particle"), std::string::npos) << found.problem;
    }
  Check rest = check_against(constant(3.0), Measure::max, 0.0);
  rest.from_s = 0.61;
  EXPECT_TRUE(judge(rest, k_scene, series).passed);
}

TEST(Judge, LooksAtWhatItShouldBeLikeToo) {
  auto series = series_of([](double) { return 3.0; });
  series.columns.push_back(series_with_gap().columns[0]);
  series.columns[1].name = "y_cm_m";
  Expectation like;
  like.like = "y_cm_m";
  const Finding found = judge(check_against(like, Measure::max, 1.0), k_scene, series);
  EXPECT_FALSE(found.passed);
  EXPECT_NE(found.problem.find("y_cm_m, which it should be like, has no value at 11 of 201 times"), std::string::npos)
      << found.problem;
}

TEST(Judge, AShiftDoesNotStepOverAGap) {
  Expectation points;
  points.points = {{0.52, 3.0, {}, {}}, {0.58, 3.0, {}, {}}};
  Check check = check_against(points, Measure::max, 1.0);
  check.largest_shift_s = 0.01;
  const Finding found = judge(check, k_scene, series_with_gap());
  EXPECT_FALSE(found.passed);
  EXPECT_TRUE(found.lacks_values);
}

TEST(Judge, AGaugeOutsideOfTheWaterChecksNothing) {
  auto series = series_of([](double) { return 0.0; });
  series.columns[0].is_dry.assign(series.columns[0].value.size(), true);
  const Check check = check_against(constant(0.0), Measure::max, 1.0);
  const Finding dry = judge(check, k_scene, series);
  EXPECT_FALSE(dry.passed);
  EXPECT_NE(dry.problem.find("outside of the water from 0 to 2 s"), std::string::npos) << dry.problem;
  series.columns[0].is_dry[150] = false;  // a wave comes late: until then the air's pressure is the right one
  EXPECT_TRUE(judge(check, k_scene, series).passed);
}

TEST(Judge, TheStartAloneIsNoCheck) {
  const auto series = series_of([](double t) { return t; });
  Expectation start;
  start.formula = "start";
  Check check = check_against(start, Measure::max, 1.0);
  check.from_s = 2.0;
  EXPECT_FALSE(judge(check, k_scene, series).passed);
  check.from_s = 1.99;
  EXPECT_TRUE(judge(check, k_scene, series).passed);
}

/// 0 of 0 is no share; it was left out by the comparison that looks for the largest.
TEST(Judge, NoShareOfNothing) {
  auto series = series_of([](double) { return 0.0; });
  series.columns.push_back(series.columns[0]);
  series.columns[1].name = "y_cm_m";
  for (double& value : series.columns[1].value) value = 1.0;
  series.columns[1].value[7] = 0.0;
  Expectation like;
  like.like = "y_cm_m";
  for (const Measure measure : {Measure::max, Measure::rms, Measure::mean, Measure::below, Measure::above}) {
    Check check = check_against(like, measure, 2.0);
    check.relative = true;
    const Finding found = judge(check, k_scene, series);
    EXPECT_FALSE(found.passed) << to_string(measure);
    EXPECT_NE(found.problem.find("relative error"), std::string::npos) << found.problem;
  }
}

TEST(ValueAt, InterpolatesAndReachesOneIntervalBeyondTheEnds) {
  Column column{"x", "m", {0.0, 1.0, 2.0}, {0.0, 10.0, std::nan("")}, false};
  EXPECT_EQ(value_at(column, 0.25), 2.5);
  EXPECT_EQ(value_at(column, 1.0), 10.0);
  EXPECT_EQ(value_at(column, -0.5), -5.0);
  EXPECT_FALSE(value_at(column, -1.5));
  column.is_mean = true;
  EXPECT_EQ(value_at(column, -0.5), 0.0);
  EXPECT_EQ(value_at(column, 0.5), 5.0);
  EXPECT_FALSE(value_at(column, 1.5));
  EXPECT_FALSE(value_at(Column{}, 0.0));
}

}  // namespace
}  // namespace squall::harness
