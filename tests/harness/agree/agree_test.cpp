#include "harness/agree/agree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/agree/agree_results.h"
#include "harness/agree/wrong_solver.h"
#include "support/scenes.h"

namespace squall::harness {
namespace {

using testing::HasSubstr;

constexpr AgreeSettings k_short{6, 3, 2};

/// Two blocks of water that fall into each other, 72 particles.
Scene splash() {
  Scene scene = test::empty_tank();
  scene.solver.speed_of_sound_m_s = 20;
  for (const double x : {0.1, 0.4}) {
    Scene::Block block;
    block.min_m = {x, 0.0, 0.1};
    block.max_m = {x + 0.2, 0.15, 0.25};
    block.velocity_m_s = {x < 0.2 ? 1.0 : -1.0, 0.0, 0.0};
    scene.blocks.push_back(block);
  }
  return scene;
}

Subject subject(const std::string& label, bool strict = true, const std::string& lacks = "") {
  Subject made;
  made.plan.label = label;
  made.plan.backend = "reference";
  made.plan.strict = strict;
  made.plan.settings.precision = Precision::single_precision;
  made.lacks = lacks;
  return made;
}

/// The reference, and subjects that do as `wrong` says if their label begins with "wrong".
AgreeResult agree_on(const Scene& scene, std::vector<Subject> subjects, const Wrong& wrong,
                     const AgreeProgress& progress = {}) {
  const SolverFactory make = [&](const RunPlan& plan) -> std::unique_ptr<Solver> {
    if (!plan.label.starts_with("wrong")) return make_solver("reference", scene, plan.settings);
    auto solver = std::make_unique<WrongSolver>(scene, plan.settings, wrong);
    solver->load(initial_particles(scene));
    return solver;
  };
  subjects.insert(subjects.begin(), subject("reference"));
  return agree(make, subjects, k_short, progress);
}

std::string notes_of(const SubjectResult& result) {
  std::string text;
  for (const auto& note : result.notes) text += note + "\n";
  return text;
}

TEST(Agree, WhatIsTheSameIsSaidToBe) {
  const AgreeResult result = agree_on(splash(), {subject("twin"), subject("wrong in nothing")}, {});
  EXPECT_TRUE(result.agree());
  ASSERT_EQ(result.subjects.size(), 3u);
  for (const auto& one : result.subjects) {
    SCOPED_TRACE(one.subject.plan.label);
    for (const Verdict verdict :
         {one.integers, one.one_step, one.bits, one.long_run, one.again, one.restart, one.hand_over})
      EXPECT_EQ(verdict, Verdict::same) << notes_of(one);
    EXPECT_EQ(one.hashes.size(), 6u);
    ASSERT_EQ(one.steps.size(), 3u) << "start, half-way, half-way at rest";
    EXPECT_TRUE(one.growth.empty());
  }
  ASSERT_EQ(result.pairs.size(), 3u);
  for (const auto& pair : result.pairs) EXPECT_TRUE(pair.bitwise && pair.promised && !pair.difference);
  EXPECT_THAT(verdict_text(result), HasSubstr("AGREE: same bits in 3 of 3 runs after each of 6 frames"));
}

TEST(Agree, SinglePrecisionIsHeldAgainstDouble) {
  const AgreeResult result = agree_on(splash(), {subject("twin")}, {});
  for (const StepCheck& step : result.subjects[1].steps) {
    SCOPED_TRACE(step.start);
    // The sum of some 50 kernel values, each of a few roundings; the pressure has its seventh power.
    EXPECT_GT(step.errors.density.max, 0.0);
    EXPECT_LT(step.errors.density.max, 50.0);
    EXPECT_GE(step.errors.density.max, step.errors.density.rms);
    EXPECT_LT(step.errors.force.rms, 1000.0);
  }
  ASSERT_EQ(result.double_growth.size(), 3u);
  EXPECT_GT(result.double_growth[0].max_dx, 0.0);
  EXPECT_LT(result.double_growth[0].max_dx, 1e-3);
  EXPECT_EQ(result.double_observed.size(), 7u);
}

struct Place {
  std::uint64_t frame;
  int substep;
  std::uint32_t particle;
  int bit;
};

class OneWrongBit : public testing::TestWithParam<Place> {};
INSTANTIATE_TEST_SUITE_P(Places, OneWrongBit,
                         testing::Values(Place{0, 0, 0, 0}, Place{0, 3, 71, 0}, Place{2, 1, 17, 0},
                                         Place{5, 2, 40, 12}));

TEST_P(OneWrongBit, IsFoundWhereItIs) {
  const Place place = GetParam();
  Wrong wrong;
  wrong.frame = place.frame;
  wrong.substep = place.substep;
  wrong.particle = place.particle;
  wrong.bit = place.bit;
  const AgreeResult result = agree_on(splash(), {subject("wrong"), subject("twin")}, wrong);
  EXPECT_FALSE(result.agree());
  EXPECT_EQ(result.subjects[1].bits, Verdict::differs);
  EXPECT_EQ(result.subjects[1].again, Verdict::same) << "wrong, but the same every time";
  EXPECT_TRUE(result.subjects[2].agrees());
  ASSERT_EQ(result.pairs.size(), 3u);
  for (const auto& pair : result.pairs) {
    const bool has_wrong = pair.first == 1 || pair.second == 1;
    ASSERT_EQ(pair.bitwise, !has_wrong);
    if (!has_wrong) continue;
    EXPECT_EQ(pair.frame, place.frame);
    ASSERT_TRUE(pair.difference && pair.difference->found_again);
    EXPECT_EQ(pair.difference->frame, place.frame);
    EXPECT_EQ(pair.difference->substep, place.substep);
    EXPECT_EQ(pair.difference->state.particle, place.particle);
    EXPECT_EQ(pair.difference->state.particles, 1u);
    EXPECT_EQ(pair.difference->state.what, "position");
    // A bit of a coordinate below 0.8 m, in spacings of 0.05 m.
    EXPECT_LE(pair.difference->state.max_position_dx, std::ldexp(20.1, place.bit - 24));
    EXPECT_GT(pair.difference->state.max_position_dx, 0.0);
  }
  EXPECT_THAT(verdict_text(result), HasSubstr("DISAGREE: same bits in 2 of 3"));
}

TEST(Agree, AnotherOrderIsFound) {
  Wrong wrong;
  wrong.frame = 3;
  wrong.reorders = true;
  const AgreeResult result = agree_on(splash(), {subject("wrong")}, wrong);
  EXPECT_FALSE(result.agree());
  ASSERT_TRUE(result.pairs[0].difference);
  EXPECT_EQ(result.pairs[0].difference->frame, 3u);
  EXPECT_EQ(result.pairs[0].difference->state.what, "place in the order");
  EXPECT_EQ(result.pairs[0].difference->state.max_position_dx, 0.0);
  // Frame 3 is also the one that the step from half-way takes.
  EXPECT_EQ(result.subjects[1].integers, Verdict::differs);
}

TEST(Agree, AWrongNeighbourCountIsFoundThoughTheWaterIsTheSame) {
  Wrong wrong;
  wrong.miscounts = true;
  const AgreeResult result = agree_on(splash(), {subject("wrong")}, wrong);
  EXPECT_FALSE(result.agree());
  EXPECT_EQ(result.subjects[1].bits, Verdict::same);
  EXPECT_EQ(result.subjects[1].integers, Verdict::differs);
  EXPECT_EQ(result.subjects[1].steps[0].integers.neighbours_differ, 1);
  EXPECT_THAT(notes_of(result.subjects[1]), HasSubstr("another number of neighbours"));
}

TEST(Agree, WhatNoStateHoldsIsSaidSo) {
  Wrong wrong;
  wrong.frame = 4;
  wrong.particle = 9;
  wrong.remembers = true;
  const AgreeResult result = agree_on(splash(), {subject("wrong")}, wrong);
  EXPECT_FALSE(result.agree());
  EXPECT_EQ(result.subjects[1].restart, Verdict::differs) << "the fault is gone with the solver that had it";
  ASSERT_TRUE(result.pairs[0].difference);
  EXPECT_FALSE(result.pairs[0].difference->found_again);
  EXPECT_THAT(difference_text(*result.pairs[0].difference), HasSubstr("not again"));
}

TEST(Agree, WithoutThePromiseRoundingIsAllowedAndNoMore) {
  Wrong rounding;
  rounding.noise = 6e-8;  // a rounding of each velocity
  const AgreeResult within = agree_on(splash(), {subject("wrong", false, "denormals")}, rounding);
  EXPECT_TRUE(within.agree()) << notes_of(within.subjects[1]);
  EXPECT_EQ(within.subjects[1].bits, Verdict::within);
  EXPECT_EQ(within.subjects[1].integers, Verdict::same);
  EXPECT_FALSE(within.subjects[1].growth.empty());
  EXPECT_EQ(within.subjects[1].observed.size(), 7u);
  EXPECT_FALSE(within.pairs[0].promised);
  EXPECT_TRUE(within.pairs[0].difference) << "where it starts to differ is told all the same";

  EXPECT_FALSE(agree_on(splash(), {subject("wrong")}, rounding).agree()) << "where bits are promised";

  Wrong coarse;
  coarse.noise = 1e-3;
  const AgreeResult beyond = agree_on(splash(), {subject("wrong", false, "denormals")}, coarse);
  EXPECT_FALSE(beyond.agree());
  EXPECT_EQ(beyond.subjects[1].bits, Verdict::differs);
  EXPECT_THAT(notes_of(beyond.subjects[1]), HasSubstr("explained by rounding"));
}

TEST(Agree, ADeviceThatFailsDoesNotKeepTheOthersFromIt) {
  Wrong wrong;
  wrong.fails_at = 2;
  const AgreeResult result = agree_on(splash(), {subject("wrong"), subject("twin")}, wrong);
  EXPECT_TRUE(result.device_failed());
  EXPECT_TRUE(result.agree()) << "a device that fails computes no other water";
  EXPECT_THAT(result.subjects[1].error, HasSubstr("is gone"));
  EXPECT_EQ(result.subjects[2].bits, Verdict::same);
  EXPECT_EQ(result.subjects[2].hand_over, Verdict::same);
}

TEST(Agree, CanBeInterrupted) {
  int asked = 0;
  const AgreeResult result =
      agree_on(splash(), {subject("twin")}, {}, [&](double, const std::string&) { return ++asked < 9; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(asked, 9);
  EXPECT_THAT(verdict_text(result), HasSubstr("interrupted"));
}

TEST(Agree, ProgressGoesToItsEnd) {
  double last = 0.0;
  agree_on(splash(), {subject("twin")}, {}, [&](double share, const std::string&) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_GT(last, 0.9);
  EXPECT_LE(last, 1.0);
}

TEST(Agree, AnEmptySceneAgrees) {
  const AgreeResult result = agree_on(test::empty_tank(), {subject("twin")}, {});
  EXPECT_TRUE(result.agree());
  EXPECT_TRUE(result.subjects[1].steps.empty());
  EXPECT_EQ(result.subjects[1].bits, Verdict::same);
  EXPECT_EQ(result.subjects[1].integers, Verdict::not_tried);
}

TEST(Agree, SceneThatBeginsWithRainHasANoiseFloor) {
  Scene scene = test::empty_tank();
  scene.container.open_top = true;
  scene.rains.push_back(test::rain_over_tank(600));
  const AgreeResult result = agree_on(scene, {subject("twin")}, {});
  EXPECT_TRUE(result.agree());
  EXPECT_EQ(result.subjects[1].steps.size(), 2u) << "half-way, as it is and at rest";
  const auto floor = [](const ObservedDistance& one) { return one.floor > 0.0; };
  EXPECT_TRUE(std::any_of(result.double_observed.begin(), result.double_observed.end(), floor));
}

TEST(Agree, TheFirstMustBeTheJudge) {
  const SolverFactory make = [](const RunPlan& plan) { return make_solver("reference", splash(), plan.settings); };
  Subject other = subject("omp");
  other.plan.backend = "omp";
  EXPECT_THROW(agree(make, {other}, k_short, {}), InputError);
  EXPECT_THROW(agree(make, {}, k_short, {}), InputError);
  EXPECT_THROW(agree(make, {subject("reference")}, {0, 3, 2}, {}), InputError);
}

}  // namespace
}  // namespace squall::harness
