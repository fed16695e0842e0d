#include "harness/tuning.h"

#include <gtest/gtest.h>

#include "harness/fake_solver.h"

namespace squall::harness {
namespace {

constexpr std::chrono::seconds k_long{60};

DeviceInfo device(const std::string& kind) {
  DeviceInfo info;
  info.kind = kind;
  info.compute_units = 2;
  return info;
}

/// A fake that says how each choice was asked for, and cannot run some.
struct Maker {
  std::vector<WorkChoice> asked;
  int refuses_parts = 0;

  std::unique_ptr<Solver> operator()(const RunPlan& plan) {
    asked.push_back({plan.settings.simd, plan.settings.work});
    EXPECT_EQ(plan.settings.readback, Readback::none) << "delivery is not what is tuned";
    if (refuses_parts != 0 && plan.settings.work.parts == refuses_parts) throw DeviceError("too many");
    return make_fake(plan);
  }
};

TEST(Tuning, TriesWhatTheDeviceSuggestsFirstAndOneChangeAtATime) {
  Maker maker;
  const Tuning tuning = tune(std::ref(maker), short_plan("cpu"), device("cpu"), k_long);
  ASSERT_FALSE(tuning.trials.empty());
  EXPECT_EQ(tuning.trials.front().choice, WorkChoice{});
  EXPECT_LE(tuning.trials.size(), maker.asked.size()) << "what looks faster is measured again";
  EXPECT_TRUE(tuning.complete);
  for (const auto& trial : tuning.trials) {
    EXPECT_GT(trial.ms_per_substep, 0.0);
    EXPECT_EQ(trial.choice.work.group, 0) << "particles in vectors have no groups";
    EXPECT_NO_THROW(check(trial.choice.work));
  }
}

TEST(Tuning, TakesTheFastest) {
  const SolverFactory make = [](const RunPlan& plan) {
    const bool fast = plan.settings.work.group == 128;
    return make_fake(plan, {.frame_lasts_ms = fast ? 0 : 5});
  };
  const Tuning tuning = tune(make, short_plan("gpu"), device("gpu"), k_long);
  EXPECT_EQ(tuning.best.work.group, 128);
  for (const auto& trial : tuning.trials) {
    EXPECT_EQ(trial.choice.simd, Simd::best) << "a device without vectors has no widths";
    EXPECT_EQ(trial.choice.work.parts, 0);
    EXPECT_EQ(trial.choice.work.chunks, 0);
  }
}

TEST(Tuning, KeepsTheWidthThatIsAskedFor) {
  Maker maker;
  RunPlan plan = short_plan("cpu");
  plan.settings.simd = Simd::avx2;
  for (const auto& trial : tune(std::ref(maker), plan, device("cpu"), k_long).trials)
    EXPECT_EQ(trial.choice.simd, Simd::avx2);
}

TEST(Tuning, PassesOverWhatTheDeviceCannotRun) {
  Maker maker;
  maker.refuses_parts = 8;
  const Tuning tuning = tune(std::ref(maker), short_plan("cpu"), device("cpu"), k_long);
  for (const auto& trial : tuning.trials) EXPECT_NE(trial.choice.work.parts, 8);
  EXPECT_NE(tuning.best.work.parts, 8);
}

TEST(Tuning, EndsAtItsTimeLimit) {
  Maker maker;
  const Tuning tuning = tune(std::ref(maker), short_plan("cpu"), device("cpu"), std::chrono::seconds(-1));
  EXPECT_EQ(tuning.trials.size(), 1u);
  EXPECT_FALSE(tuning.complete);
}

TEST(Tuning, EndsWhenItIsTold) {
  Maker maker;
  int asked = 0;
  const auto twice = [&] { return ++asked <= 2; };
  const Tuning tuning = tune(std::ref(maker), short_plan("cpu"), device("cpu"), k_long, twice);
  EXPECT_EQ(tuning.trials.size(), 3u);
  EXPECT_FALSE(tuning.complete);
}

TEST(Tuning, FailsWithTheDevice) {
  const SolverFactory broken = [](const RunPlan& plan) { return make_fake(plan, {.device_fails_at = 0}); };
  EXPECT_THROW(tune(broken, short_plan("cpu"), device("cpu"), k_long), DeviceError);
}

TEST(Tuning, ChoicesHaveNames) {
  EXPECT_EQ(to_string(WorkChoice{}), "as the device suggests");
  EXPECT_EQ(to_string(WorkChoice{Simd::avx2, {0, 8, 1}}), "float8, parts per unit: 8, chunks per unit: 1");
  EXPECT_EQ(to_string(WorkChoice{Simd::scalar, {128, 0, 0}}), "a particle per work-item, work groups of 128");
}

}  // namespace
}  // namespace squall::harness
