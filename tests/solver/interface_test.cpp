// What the interface promises on every backend: delivery, append, save and go on, errors, independence.
#include <cmath>
#include <vector>

#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

class Interface : public OnEveryBackend {
 protected:
  /// A tank that has everything: water, a box that vanishes, a held block, motion and rain.
  static Scene busy_scene() {
    Scene scene = filled_tank(3);
    scene.container.open_top = true;
    scene.blocks[0].max_m.x() = 0.3;
    scene.boxes = {{{0.4, 0, 0}, {0.45, 0.1, 0.4}, 0.06}};
    Scene::Block held;
    held.min_m = {0.5, 0.3, 0.1};
    held.max_m = {0.7, 0.5, 0.3};
    held.held_until_s = 0.05;
    scene.blocks.push_back(held);
    scene.container.motions.push_back({0.02, 0.2, Eigen::Vector3d(-0.05, 0, 0), std::nullopt});
    scene.rains.push_back(rain_over_tank(300));
    return scene;
  }
};
SQUALL_ON_EVERY_BACKEND(Interface);

TEST_P(Interface, DeliversThePositionsOfTheStateInItsOrder) {
  const auto solver = make(busy_scene());
  for (int frame = 0; frame < 5; ++frame) {
    const FrameReport& report = solver->advance();
    const PositionsView view = solver->positions();
    ASSERT_EQ(static_cast<std::int64_t>(view.count), report.particles);
    ASSERT_EQ(view.frame, solver->clock().frame);
    ASSERT_EQ(report.readback_bytes, 12 * view.count);
    std::vector<float> delivered;
    for (std::size_t i = 0; i < view.count; ++i)
      for (int axis = 0; axis < 3; ++axis) delivered.push_back(view.position(i)[axis]);
    const Particles particles = solver->state().particles;
    ASSERT_EQ(particles.size(), view.count);
    for (std::size_t i = 0; i < view.count; ++i)
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_EQ(delivered[3 * i + static_cast<std::size_t>(axis)], static_cast<float>(particles.positions[i][axis]));
  }
  solver->advance(Delivery::nothing);
  EXPECT_EQ(solver->positions().count, 0u);
}

TEST_P(Interface, RainAndHeldBlocksJoinOnTime) {
  const auto solver = make(busy_scene());
  const std::int64_t water = 6 * 3 * 8, held = 4 * 4 * 4;
  for (int frame = 0; frame < 8; ++frame) {
    const FrameReport& report = solver->advance();
    EXPECT_EQ(report.particles, water + held + 5 * frame) << "five drops a frame";
    EXPECT_EQ(report.active, report.particles - (frame < 3 ? held : 0)) << "frame " << frame;
  }
}

// Save after some frames, go on in a new solver: the same as going on.
TEST_P(Interface, RestoreThenRunEqualsRun) {
  const Scene scene = busy_scene();
  const auto straight = make(scene), resumed = make(scene);
  for (int frame = 0; frame < 3; ++frame) straight->advance();
  resumed->restore(straight->state());
  for (int frame = 3; frame < 8; ++frame) {
    straight->advance();
    resumed->advance();
    ASSERT_EQ(first_difference(resumed->state().particles, straight->state().particles), "") << "frame " << frame;
    ASSERT_EQ(resumed->clock().rained, straight->clock().rained);
  }
}

TEST_P(Interface, LoadStartsOver) {
  const Scene scene = busy_scene();
  const auto fresh = make(scene), used = make(scene);
  for (int frame = 0; frame < 4; ++frame) used->advance();
  used->load(initial_particles(scene));
  EXPECT_EQ(used->clock().frame, 0u);
  for (int frame = 0; frame < 4; ++frame) {
    fresh->advance();
    used->advance();
  }
  EXPECT_EQ(first_difference(used->state().particles, fresh->state().particles), "");
}

// Two solvers at once do not see each other.
TEST_P(Interface, SolversAreIndependent) {
  const Scene scene = busy_scene(), other_scene = filled_tank(2);
  const auto alone = make(scene);
  for (int frame = 0; frame < 3; ++frame) alone->advance();
  const auto solver = make(scene), other = make(other_scene);
  for (int frame = 0; frame < 3; ++frame) {
    solver->advance();
    other->advance();
  }
  EXPECT_EQ(first_difference(solver->state().particles, alone->state().particles), "");
}

// An appended particle comes last, gets the next id and, its velocity belonging to now, follows its parabola: it is
// half a kick ahead of the others.
TEST_P(Interface, AppendedParticlesFollowTheirParabola) {
  Scene scene = tank_with(random_particles(1, {0.1, 0.3, 0.1}, {0.11, 0.31, 0.11}, 0, 1));
  scene.container.open_top = true;
  scene.rains.push_back(rain_over_tank(1e-3));  // makes room, and drops nothing in this time
  const auto solver = make(scene);
  solver->advance();
  Particles late;
  late.add(77, {0.5, 0.3, 0.25}, {0.25, 0.5, 0});
  solver->append(late);
  EXPECT_EQ(solver->state().particles.ids, (std::vector<std::uint32_t>{0, 1}));
  int substeps = 0;
  for (int frame = 0; frame < 3; ++frame) substeps += solver->advance().substeps;
  const double t = 3.0 / 60;
  const Eigen::Vector3d exact = late.positions[0] + t * late.velocities[0] + t * t / 2 * scene.gravity_m_s2;
  const Eigen::Vector3d x = by_id(solver->state().particles).at(1).position;
  // air takes g (v/v_t)^2 at most, v below 0.75 m/s, v_t = 7.95 m/s
  const double air = 9.81 * std::pow(0.75 / 7.95, 2) * t * t / 2;
  EXPECT_LE((x - exact).norm(), rounding(2 * substeps, 1) + air);
}

TEST_P(Interface, RefusesWhatItCannotUse) {
  const auto solver = make(filled_tank(1));
  const Particles good = solver->state().particles;
  Particles twin = good;
  twin.ids[1] = twin.ids[0];
  EXPECT_THROW(solver->load(twin), InputError);
  Particles ragged = good;
  ragged.velocities.pop_back();
  EXPECT_THROW(solver->load(ragged), InputError);
  Particles one_more;
  one_more.add(0, {0.1, 0.3, 0.1}, {0, 0, 0});
  EXPECT_THROW(solver->append(one_more), InputError) << "there is no room";
  State other_rains = solver->state();
  other_rains.clock.rained.push_back(3);
  EXPECT_THROW(solver->restore(other_rains), InputError);
  EXPECT_EQ(solver->state().particles.size(), good.size()) << "refused, not half taken";
  EXPECT_EQ(solver->advance().active, static_cast<std::int64_t>(good.size()));
}

TEST_P(Interface, SaysWhatItIs) {
  const auto solver = make(filled_tank(1));
  EXPECT_EQ(solver->info().backend, GetParam().backend);
  EXPECT_FALSE(solver->info().device.empty());
  if (GetParam().backend == "omp") {
    EXPECT_EQ(solver->info().threads, GetParam().settings.threads);
    if (GetParam().settings.simd != Simd::best) {
      EXPECT_EQ(solver->info().simd, to_string(GetParam().settings.simd));
    }
  }
}

// A state is carried from any backend to any other: each frame on another one gives the bits of one alone.
TEST(HandOver, FromBackendToBackendKeepsTheBits) {
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller}) {
    const Scene scene = filled_tank(4);
    const std::vector<BackendUnderTest> backends = bitwise_backends(pressure);
    const auto alone = backends[0].make(scene);
    State carried = alone->state();
    for (const BackendUnderTest& backend : backends) {
      alone->advance();
      const auto next = backend.make(scene);
      next->restore(carried);
      next->advance();
      carried = next->state();
      ASSERT_EQ(first_difference(carried.particles, alone->state().particles), "") << backend.name;
    }
  }
}

}  // namespace
}  // namespace squall::test
