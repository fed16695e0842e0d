#include "harness/row.h"

#include <gtest/gtest.h>

namespace squall::harness {
namespace {

FrameRecord frame(double frame_ms, double readback_ms, int substeps, std::int64_t active, double neighbours) {
  FrameRecord record;
  record.report.frame_ms = frame_ms;
  record.report.readback_ms = readback_ms;
  record.report.upload_ms = 1.0;
  record.report.compute_ms = frame_ms - readback_ms - 1.0;
  record.report.substeps = substeps;
  record.report.active = active;
  record.report.neighbours_mean = neighbours;
  record.report.density_error_mean = neighbours / 100.0;
  record.report.density_error_max = neighbours / 10.0;
  record.report.clamps = 2;
  record.report.readback_bytes = 16;
  return record;
}

TEST(Row, FollowsFromItsFrames) {
  Row row;
  summarise({frame(10.0, 1.0, 4, 100, 30.0), frame(20.0, 2.0, 2, 300, 10.0), frame(12.0, 1.0, 3, 0, 0.0)}, 0.025, row);
  EXPECT_EQ(row.frames, 3);
  EXPECT_EQ(row.steps, 9);
  EXPECT_DOUBLE_EQ(row.simulated_s, 0.075);
  EXPECT_DOUBLE_EQ(row.wall_s, 0.042);
  EXPECT_DOUBLE_EQ(row.realtime_factor, 0.075 / 0.042);
  EXPECT_DOUBLE_EQ(row.fps, 1000.0 / 12.0);
  EXPECT_DOUBLE_EQ(row.frame_ms.max, 20.0);
  EXPECT_DOUBLE_EQ(row.readback_share, 4.0 / 42.0);
  EXPECT_DOUBLE_EQ(row.readback_bytes_per_frame, 16.0);
  // Compute takes 8 + 17 + 10 ms for 4 x 100 + 2 x 300 particle-steps.
  EXPECT_DOUBLE_EQ(row.particle_steps_per_s, 1000.0 / 0.035);
  EXPECT_DOUBLE_EQ(row.pairs_per_s, (400.0 * 30.0 + 600.0 * 10.0) / 0.035);
  EXPECT_DOUBLE_EQ(row.neighbours_mean, (100.0 * 30.0 + 300.0 * 10.0) / 400.0);
  EXPECT_DOUBLE_EQ(row.density_error_mean, (100.0 * 0.3 + 300.0 * 0.1) / 400.0);
  EXPECT_DOUBLE_EQ(row.density_error_max, 3.0);
  EXPECT_DOUBLE_EQ(row.density_error_worst, 0.3);
  EXPECT_EQ(row.clamps, 6);
}

TEST(Row, TellsWhatSolvesTook) {
  FrameRecord first = frame(10.0, 1.0, 4, 100, 30.0), second = frame(10.0, 1.0, 6, 300, 30.0);
  for (auto* record : {&first, &second}) {
    record->report.density_iterations = 30;
    record->report.divergence_iterations = 10;
    record->report.light_passes = 60;
  }
  first.report.density_iterations_max = 9;
  second.report.density_iterations_max = 5;
  second.report.divergence_iterations_max = 3;
  first.report.unconverged = 1;
  second.report.unconverged = 2;
  Row untimed, timed;
  summarise({first, second}, 0.025, untimed);
  EXPECT_DOUBLE_EQ(untimed.iterations_mean, 8.0);
  EXPECT_DOUBLE_EQ(untimed.density_iterations_mean, 6.0);
  EXPECT_DOUBLE_EQ(untimed.divergence_iterations_mean, 2.0);
  EXPECT_EQ(untimed.density_iterations_max, 9);
  EXPECT_EQ(untimed.divergence_iterations_max, 3);
  EXPECT_EQ(untimed.unconverged, 3);
  EXPECT_DOUBLE_EQ(untimed.light_passes_mean, 12.0);
  EXPECT_FALSE(untimed.light_pass_ns);
  first.report.light_passes_ms = second.report.light_passes_ms = 6.0;
  summarise({first, second}, 0.025, timed);
  // 12 ms for 100 x 60 + 300 x 60 particles and passes.
  EXPECT_DOUBLE_EQ(timed.light_pass_ns.value(), 12e6 / 24000.0);
}

TEST(Row, OfNoFramesIsZeroAndFinite) {
  Row row;
  summarise({}, 0.025, row);
  EXPECT_EQ(row.frames, 0);
  EXPECT_EQ(row.fps, 0.0);
  EXPECT_EQ(row.particle_steps_per_s, 0.0);
  EXPECT_EQ(row.readback_share, 0.0);
}

}  // namespace
}  // namespace squall::harness
