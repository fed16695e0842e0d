#include "backend_opencl/command_trace.h"

#include <gtest/gtest.h>

namespace squall::opencl {
namespace {

TEST(ClockShift, LiesInTheMiddleOfWhatIsPossible) {
  // The device's clock is 100 ms behind. Commands start 2 and 1 ms after they were asked for; the host sees the end 3
  // ms late.
  const ClockShift clock = clock_shift({{1000.0, 1010.0}, {902.0, 911.0}, {1023.0}, {920.0}});
  EXPECT_DOUBLE_EQ(clock.shift, 0.5 * (99.0 + 103.0));
  EXPECT_DOUBLE_EQ(clock.error, 2.0);
  EXPECT_LE(std::abs(clock.shift - 100.0), clock.error);
}

TEST(ClockShift, MoreWaitsNarrowIt) {
  const ClockShift once = clock_shift({{10.0}, {5.0}, {40.0}, {30.0}});
  const ClockShift twice = clock_shift({{10.0}, {5.0}, {40.0, 50.0}, {30.0, 44.0}});
  EXPECT_DOUBLE_EQ(once.error, 2.5);
  EXPECT_DOUBLE_EQ(twice.error, 0.5);
  EXPECT_DOUBLE_EQ(twice.shift, 5.5);
}

TEST(ClockShift, BoundsThatContradictEachOtherSayByHowMuch) {
  const ClockShift clock = clock_shift({{10.0}, {5.0}, {12.0}, {9.0}});
  EXPECT_DOUBLE_EQ(clock.shift, 4.0);
  EXPECT_DOUBLE_EQ(clock.error, 1.0);
}

TEST(ClockShift, NothingToGoByIsNoShift) {
  EXPECT_EQ(clock_shift({}).shift, 0.0);
  EXPECT_EQ(clock_shift({{1.0}, {2.0}, {}, {}}).error, 0.0);
}

TEST(CommandTrace, NotesNothingWhileItIsOff) {
  CommandTrace trace(false);
  const cl::Event event;
  trace.add(&event, "density");
  trace.finished();
  trace.host("wait", {});
  FrameReport report;
  trace.take({}, report);
  EXPECT_TRUE(report.spans.empty());
}

TEST(CommandTrace, WhatTheHostDidCountsFromTheFrame) {
  CommandTrace trace(true);
  const auto start = std::chrono::steady_clock::now();
  trace.host("wait", start + std::chrono::milliseconds(-3));
  FrameReport report;
  trace.take(start, report);
  ASSERT_EQ(report.spans.size(), 1u);
  EXPECT_EQ(report.spans[0].lane, "host");
  EXPECT_DOUBLE_EQ(report.spans[0].begin_ms, -3.0);
  EXPECT_GE(report.spans[0].end_ms, 0.0);
  FrameReport next;
  trace.take(start, next);
  EXPECT_TRUE(next.spans.empty()) << "taken once";
}

}  // namespace
}  // namespace squall::opencl
