// A frame sub-step by sub-step: the same bits as in one go, and a state from within goes on anywhere.
#include "core/state_hash.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

/// Rain, held water, a box that vanishes and a container that moves: all that a sub-step's table can say.
Scene tiny() { return load_scene(SQUALL_TEST_SCENES_DIR "/tiny.toml"); }

class Substeps : public OnEveryBackend {
 protected:
  void expect_equal(Solver& solver, Solver& expected) const {
    const State a = solver.state(), b = expected.state();
    EXPECT_EQ(a.particles.ids, b.particles.ids);
    EXPECT_EQ(first_difference(a.particles, b.particles), "");
    EXPECT_EQ(a.clock.frame, b.clock.frame);
    EXPECT_EQ(a.clock.substep, b.clock.substep);
    EXPECT_EQ(a.clock.previous_substeps, b.clock.previous_substeps);
    EXPECT_EQ(a.clock.previous_dt, b.clock.previous_dt);
    EXPECT_EQ(a.clock.max_speed, b.clock.max_speed);
    EXPECT_EQ(a.clock.max_acceleration, b.clock.max_acceleration);
    EXPECT_EQ(a.clock.next_id, b.clock.next_id);
    EXPECT_EQ(a.clock.rained, b.clock.rained);
  }
};
SQUALL_ON_EVERY_BACKEND(Substeps);

TEST_P(Substeps, OneByOneGiveTheFrame) {
  const auto whole = make(tiny()), parts = make(tiny());
  for (int frame = 0; frame < 3; ++frame) {
    const int substeps = whole->advance().substeps;
    for (int substep = 1; substep <= substeps; ++substep) {
      EXPECT_EQ(parts->clock().frame, static_cast<std::uint64_t>(frame));
      EXPECT_EQ(parts->advance_substep().substeps, 1);
      EXPECT_EQ(parts->clock().substep, substep % substeps);
      EXPECT_EQ(parts->report().frame, static_cast<std::uint64_t>(frame));
    }
    expect_equal(*parts, *whole);
    EXPECT_EQ(parts->report().neighbours_mean, whole->report().neighbours_mean) << "of the last sub-step";
  }
}

TEST_P(Substeps, AStateFromWithinAFrameGoesOn) {
  const auto whole = make(tiny()), parts = make(tiny()), other = make(tiny());
  whole->advance();
  whole->advance();
  parts->advance();
  parts->advance_substep();
  const State within = parts->state();
  EXPECT_EQ(within.clock.frame, 1u);
  EXPECT_EQ(within.clock.substep, 1);
  other->restore(within);
  other->advance();
  expect_equal(*other, *whole);
  parts->advance();
  expect_equal(*parts, *whole);
}

TEST(SubstepsOfAnySolver, NothingIsAddedWithinAFrame) {
  const auto solver = make_solver("reference", tiny(), Settings{});
  solver->advance_substep();
  EXPECT_THROW(solver->append(random_particles(1, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, 0, 1)), InputError);
  solver->advance();
  EXPECT_NO_THROW(solver->append(random_particles(1, {0.1, 0.25, 0.1}, {0.1, 0.25, 0.1}, 0, 1)));
}

TEST(SubstepsOfAnySolver, MoreThanAFrameHasAreRefused) {
  const auto solver = make_solver("reference", tiny(), Settings{});
  State state = solver->state();
  state.clock.substep = k_max_substeps;
  solver->restore(state);
  EXPECT_THROW(solver->advance(), InputError);
  state.clock.substep = -1;
  EXPECT_THROW(solver->restore(state), InputError);
}

TEST(SubstepsOfAnySolver, LoadingEndsTheFrameUnderWay) {
  const auto solver = make_solver("reference", tiny(), Settings{});
  solver->advance_substep();
  solver->load(initial_particles(tiny()));
  EXPECT_EQ(solver->clock().substep, 0);
}

}  // namespace
}  // namespace squall::test
