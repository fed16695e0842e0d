#include "harness/agree/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "harness/agree/noise_floor.h"
#include "harness/agree/one_step.h"

namespace squall::harness {
namespace {

State some_state() {
  State state;
  for (std::uint32_t id = 0; id < 5; ++id) state.particles.add(id, {0.1 * id, 0.25, 0.5}, {1.0, -2.0, 0.0}, 0.5 * id);
  state.clock.frame = 3;
  state.clock.next_id = 5;
  state.clock.max_speed = 2.5;
  return state;
}

/// One step further, in the last place of double precision.
double next_to(double value) { return std::nextafter(value, 10.0); }

TEST(ExactHash, SeesEveryBitOfWhatContinuesARun) {
  const State state = some_state();
  const auto hash = exact_hash(state);
  EXPECT_EQ(exact_hash(some_state()), hash);
  const auto differs = [&](auto change) {
    State other = state;
    change(other);
    return exact_hash(other) != hash;
  };
  EXPECT_TRUE(differs([](State& s) { s.particles.positions[4].z() = next_to(0.5); }));
  EXPECT_TRUE(differs([](State& s) { s.particles.velocities[2].z() = -0.0; }));
  EXPECT_TRUE(differs([](State& s) { s.particles.pressures[1] = next_to(0.5); }));
  EXPECT_TRUE(differs([](State& s) { s.particles.ids[1] = 7; }));
  EXPECT_TRUE(differs([](State& s) { s.clock.max_speed = next_to(2.5); }));
  EXPECT_TRUE(differs([](State& s) { s.clock.previous_substeps = 4; }));
  EXPECT_TRUE(differs([](State& s) {
    std::swap(s.particles.ids[0], s.particles.ids[1]);
    std::swap(s.particles.positions[0], s.particles.positions[1]);
    std::swap(s.particles.pressures[0], s.particles.pressures[1]);
  })) << "the same water in another order";
}

TEST(CompareStates, NamesTheLowestParticleAndCounts) {
  const State a = some_state();
  EXPECT_FALSE(compare_states(a, a, 0.1));
  State b = a;
  b.particles.velocities[4].x() += 3.0;
  b.particles.positions[2].y() += 0.05;
  const auto found = compare_states(a, b, 0.1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->particle, 2u);
  EXPECT_EQ(found->what, "position");
  EXPECT_EQ(found->particles, 2u);
  EXPECT_NEAR(found->max_position_dx, 0.5, 1e-12);
  EXPECT_NEAR(found->max_velocity, 3.0, 1e-12);
}

TEST(CompareStates, TellsMissingOnesOrderPressureAndClock) {
  const State a = some_state();
  State b = a;
  b.particles.ids[3] = 9;
  EXPECT_EQ(compare_states(a, b, 0.1)->what, "presence");
  EXPECT_EQ(compare_states(a, b, 0.1)->particle, 3u);
  EXPECT_EQ(compare_states(a, b, 0.1)->particles, 2u);
  EXPECT_TRUE(std::isinf(compare_states(a, b, 0.1)->max_position_dx));
  b = a;
  b.particles.pressures[3] += 1.0;
  EXPECT_EQ(compare_states(a, b, 0.1)->what, "pressure");
  b = a;
  b.clock.max_speed += 1.0;
  EXPECT_EQ(compare_states(a, b, 0.1)->particles, 0u);
  b = a;
  b.particles.positions[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(compare_states(a, b, 0.1)->max_position_dx));
}

TEST(StepErrors, AreUnitsInTheLastPlaceOfTheLargestValue) {
  OneStep exact;
  exact.after = some_state().particles;
  for (int i = 0; i < 5; ++i) {
    exact.fields.densities.push_back(1.0 + 0.01 * i);  // in [1, 2): one ulp is 2^-23
    exact.fields.pressures.push_back(100.0);           // in [64, 128): 2^-17
    exact.fields.neighbours.push_back(30);
    exact.forces.emplace_back(0.0, -9.0, 0.0);  // in [8, 16): 2^-20
  }
  OneStep step = exact;
  EXPECT_EQ(step_errors(exact, step).density.max, 0.0);
  step.fields.densities[2] += std::ldexp(3.0, -23);
  step.fields.pressures[0] -= std::ldexp(2.0, -17);
  step.forces[4].x() += std::ldexp(1.0, -20);
  step.fields.neighbours[1] = 31;
  // Matched by id, whatever the order.
  std::swap(step.after.ids[1], step.after.ids[2]);
  std::swap(step.fields.densities[1], step.fields.densities[2]);
  std::swap(step.fields.neighbours[1], step.fields.neighbours[2]);
  const StepErrors errors = step_errors(exact, step);
  EXPECT_NEAR(errors.density.max, 3.0, 1e-6);
  EXPECT_NEAR(errors.density.rms, 3.0 / std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(errors.pressure.max, 2.0, 1e-6);
  EXPECT_NEAR(errors.force.max, 1.0, 1e-6);
  EXPECT_EQ(errors.neighbours_differ, 1);
}

TEST(Perturbed, MovesEveryNumberByOnePlace) {
  const State state = some_state();
  const State moved = perturbed(state, 1), other = perturbed(state, 2);
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto was = static_cast<float>(state.particles.velocities[i][axis]);
      const auto is = static_cast<float>(moved.particles.velocities[i][axis]);
      EXPECT_TRUE(is == std::nextafter(was, 9.0f) || is == std::nextafter(was, -9.0f)) << is;
    }
    EXPECT_NE(moved.particles.positions[i], state.particles.positions[i]);
    EXPECT_LT((moved.particles.positions[i] - state.particles.positions[i]).norm(), 1e-7);
  }
  EXPECT_NE(exact_hash(moved), exact_hash(other));
  EXPECT_EQ(exact_hash(moved), exact_hash(perturbed(state, 1)));
}

}  // namespace
}  // namespace squall::harness
