#include "harness/run.h"

#include <gtest/gtest.h>

#include "harness/fake_solver.h"

namespace squall::harness {
namespace {

TEST(Run, CountsFramesAfterTheWarmUp) {
  const RunPlan plan = short_plan("fake");
  const Row row = run_once(make_fake(plan), plan);
  EXPECT_EQ(row.error, "");
  EXPECT_EQ(row.frames, 6);
  EXPECT_FALSE(row.interrupted);
  EXPECT_EQ(row.particles, 64);
  EXPECT_DOUBLE_EQ(row.simulated_s, 0.6);
  EXPECT_GT(row.fps, 0.0);
  EXPECT_EQ(row.readback_bytes_per_frame, 64.0 * 12.0);
  EXPECT_EQ(row.readback_copied_bytes_per_frame, 1000.0);
  EXPECT_EQ(row.readback_latency_frames, 0);
  EXPECT_EQ(row.solver.device, "fake device");
}

TEST(Run, RewindingLeavesNoTraceOfTheWarmUp) {
  RunPlan plan = short_plan("fake");
  plan.warm_up_frames = 0;
  const Row cold = run_once(make_fake(plan), plan);
  plan.warm_up_frames = 3;
  plan.rewind = true;
  std::vector<double> times;
  const Row warm = run_once(make_fake(plan), plan, [&](const harness::Run& run) {
    if (!run.frames().empty()) times.push_back(run.frames().back().time_s);
    return true;
  });
  EXPECT_EQ(warm.state_hash, cold.state_hash);
  EXPECT_EQ(warm.steps, cold.steps);
  ASSERT_EQ(times.size(), 6u);
  EXPECT_DOUBLE_EQ(times.front(), 0.1);
  plan.rewind = false;
  EXPECT_NE(run_once(make_fake(plan), plan).state_hash, cold.state_hash);
}

TEST(Run, WithoutReadBackDeliversNothing) {
  const RunPlan plan = short_plan("fake", "opencl", Readback::none);
  EXPECT_EQ(run_once(make_fake(plan), plan).readback_bytes_per_frame, 0.0);
}

TEST(Run, StopsWhenAsked) {
  const RunPlan plan = short_plan("fake");
  const Row row = run_once(make_fake(plan), plan, [](const harness::Run& run) { return run.frames().size() < 2; });
  EXPECT_EQ(row.error, "");
  EXPECT_EQ(row.frames, 2);
  EXPECT_TRUE(row.interrupted);
}

TEST(Run, LostParticlesMakeAnErrorRow) {
  const RunPlan plan = short_plan("fake");
  Faults faults;
  faults.loses_at = 4;
  const Row row = run_once(make_fake(plan, faults), plan);
  EXPECT_NE(row.error.find("1 of 64 particles"), std::string::npos) << row.error;
  EXPECT_EQ(row.lost_particles, 1);
  EXPECT_FALSE(row.device_failed);
  EXPECT_FALSE(row.interrupted);
  EXPECT_EQ(row.frames, 3);
}

TEST(Run, WrongPositionsMakeAnErrorRow) {
  const RunPlan plan = short_plan("fake");
  Faults faults;
  faults.delivers_wrong_at = 4;
  const Row row = run_once(make_fake(plan, faults), plan);
  EXPECT_NE(row.error.find("wrong positions are delivered with frame 4: particle 7 is off by 0.01 m"),
            std::string::npos)
      << row.error;
  EXPECT_FALSE(row.device_failed);
  EXPECT_EQ(row.frames, 3);
}

TEST(Run, ATimeStepThatIsTooLongSaysWhatToChange) {
  RunPlan plan = short_plan("fake");
  plan.warm_up_frames = 0;
  plan.settings.pressure = Pressure::wcsph;
  Faults faults;
  faults.hurries_from = 0;
  faults.loses_at = 1;
  const Row row = run_once(make_fake(plan, faults), plan);
  EXPECT_NE(row.error.find("unstable after frame 1: 1000 sub-steps of 0.0001 s"), std::string::npos) << row.error;
  EXPECT_NE(row.error.find("1e+06 m/s"), std::string::npos) << row.error;
  EXPECT_NE(row.error.find("lower that speed or speed_of_sound_m_s"), std::string::npos) << row.error;
  plan.settings.pressure = Pressure::dfsph;
  const std::string dfsph = run_once(make_fake(plan, faults), plan).error;
  EXPECT_NE(dfsph.find("lower that speed, or raise spacing_m or frame_rate_hz"), std::string::npos) << dfsph;
  EXPECT_EQ(dfsph.find("sound"), std::string::npos) << "dfsph has none: " << dfsph;
  EXPECT_EQ(dfsph.find("viscosity"), std::string::npos) << "which is not to blame: " << dfsph;
}

TEST(Run, AFailureInARewoundWarmUpLeavesItsFrames) {
  RunPlan plan = short_plan("fake");
  plan.rewind = true;
  Faults faults;
  faults.loses_at = 1;
  std::vector<std::uint64_t> frames;
  const Row row = run_once(make_fake(plan, faults), plan, [&](const harness::Run& run) {
    if (!run.frames().empty()) frames.push_back(run.frames().back().report.frame);
    return true;
  });
  EXPECT_EQ(row.error, "1 of 64 particles are lost after frame 1");
  EXPECT_EQ(frames, (std::vector<std::uint64_t>{0, 1}));
}

TEST(Run, StatesThatAreNotFiniteMakeAnErrorRow) {
  const RunPlan plan = short_plan("fake");
  Faults faults;
  faults.states_not_finite = true;
  const Row row = run_once(make_fake(plan, faults), plan);
  EXPECT_NE(row.error.find("not finite"), std::string::npos) << row.error;
  EXPECT_FALSE(row.energy_drift);
}

TEST(Run, AFailingDeviceEndsTheRunAndIsSaid) {
  const RunPlan plan = short_plan("fake");
  Faults faults;
  faults.device_fails_at = 3;
  int calls = 0;
  const Row row = run_once(make_fake(plan, faults), plan, [&](const harness::Run&) { return ++calls > 0; });
  EXPECT_EQ(calls, 3) << "the frame that failed left no record";
  EXPECT_TRUE(row.device_failed);
  EXPECT_NE(row.error.find("the fake device is gone"), std::string::npos) << row.error;
  EXPECT_EQ(row.frames, 1);
}

TEST(Run, MemoryThatRunsOutEndsTheRunAndKeepsItsState) {
  RunPlan plan = short_plan("fake");
  plan.warm_up_frames = 0;
  Faults faults;
  faults.runs_out_of_memory_at = 4;
  harness::Run run(make_fake(plan, faults), plan);
  const Row row = run_to_end(run);
  EXPECT_TRUE(run.device_failed());
  EXPECT_NE(row.error.find("out of memory"), std::string::npos) << row.error;
  EXPECT_EQ(row.frames, 4);
  EXPECT_EQ(run.state().clock.frame, 4u) << "the last one that is whole";
}

// What a run went on from counts as brought in: half of the energy is then a drift of +100 %.
TEST(Run, EnergyDriftCountsFromWhereTheWaterBegan) {
  RunPlan plan = short_plan("fake");
  const double energy = harness::Run(make_fake(plan), plan).energy_in();
  ASSERT_GT(energy, 0.0);
  const double drift = run_once(make_fake(plan), plan).energy_drift.value_or(-1);
  plan.energy_in_j = energy / 2;
  EXPECT_NEAR(run_once(make_fake(plan), plan).energy_drift.value_or(-1), 2 * drift + 1, 1e-12);
}

TEST(Run, SaysWhatItGoesOnFrom) {
  const RunPlan plan = short_plan("fake");
  auto solver = make_fake(plan);
  EXPECT_EQ(run_once(make_fake(plan), plan).start_frame, 0u);
  for (int frame = 0; frame < 3; ++frame) solver->advance();
  EXPECT_EQ(run_once(std::move(solver), plan).start_frame, 3u);
}

TEST(Run, RefusesPlansThatMeasureNothing) {
  RunPlan plan = short_plan("fake");
  plan.frames = 0;
  EXPECT_THROW(run_once(make_fake(plan), plan), InputError);
  plan.frames = 1;
  plan.warm_up_frames = -1;
  EXPECT_THROW(run_once(make_fake(plan), plan), InputError);
}

TEST(Profile, MeansPhasesOverFramesOfItsOwnRun) {
  const RunPlan plan = short_plan("fake");
  const auto start = make_fake(plan)->state();
  const auto make = [](const RunPlan& what) { return make_fake(what); };
  const Profile profile = profile_run(make, plan, start);
  ASSERT_EQ(profile.phase_ms.count("density"), 1u);
  EXPECT_DOUBLE_EQ(profile.phase_ms.at("density"), 3.0);
  Row row;
  add_profile(profile, row);
  EXPECT_DOUBLE_EQ(row.readback_copy_ms.value_or(0), 2.0);
  EXPECT_DOUBLE_EQ(row.readback_overlap.value_or(0), 0.25);
  const Profile none = profile_run(make, short_plan("fake", "reference"), start);
  EXPECT_TRUE(none.phase_ms.empty());
  add_profile(none, row);
  EXPECT_TRUE(row.phase_ms.empty());
  EXPECT_FALSE(row.readback_copy_ms);
  EXPECT_FALSE(row.readback_overlap);
}

}  // namespace
}  // namespace squall::harness
