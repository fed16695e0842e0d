// Viscosity far beyond water's: the time step must follow, so that speeds decay and nothing is thrown out.

#include <random>

#include "solver/backends_under_test.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

class Viscosity : public OnEveryBackend {};
SQUALL_ON_EVERY_BACKEND(Viscosity);

TEST_P(Viscosity, OfSyrupCalmsRandomMotion) {
  Scene scene = filled_tank(4);
  scene.gravity_m_s2.setZero();
  scene.fluid.viscosity_m2_s = 1.0;
  scene.solver.speed_of_sound_m_s = 10.0;
  std::mt19937 random(17);
  std::uniform_real_distribution<double> speed(-0.5, 0.5);
  Particles particles = initial_particles(scene);
  double start = 0.0;
  for (auto& velocity : particles.velocities) {
    velocity = {speed(random), speed(random), speed(random)};
    start += velocity.squaredNorm();
  }
  const auto solver = make(scene);
  solver->load(particles);
  for (int frame = 0; frame < 2; ++frame) ASSERT_EQ(solver->advance().lost, 0);
  double end = 0.0;
  for (const auto& velocity : solver->state().particles.velocities) end += velocity.squaredNorm();
  // Nearly all of random motion has wavelengths below 8 dx, where nu k^2 t exceeds (pi/0.2 m)^2 x 1 m^2/s x 1/30 s = 8;
  // what is longer holds about a hundredth of the energy.
  EXPECT_LT(end, 0.1 * start);
}

// A collapse of pitch: steps as long as viscosity allows leave nothing that rings. What does shows as accelerations,
// and the plan shortens its steps for them: with dt <= 0.03 H^2/nu to the least there is, from the twentieth frame on.
TEST(ViscosityOfWcsph, LeavesNothingThatRings) {
  Scene scene = empty_tank();
  scene.container.max_m = {0.9, 1.2, 0.5};
  scene.container.open_top = true;
  scene.fluid.viscosity_m2_s = 2.0;
  scene.solver.speed_of_sound_m_s = 20.0;
  Scene::Block block;
  block.min_m = {0.0, 0.0, 0.0};
  block.max_m = {0.5, 0.7, 0.5};
  scene.blocks.push_back(block);
  Settings settings;
  settings.pressure = Pressure::wcsph;
  const auto solver = make_solver("omp", scene, settings);
  solver->load(initial_particles(scene));
  const auto viscous = static_cast<int>(substeps_needed(scene, Pressure::wcsph, 0.0));
  for (int frame = 0; frame < 24; ++frame) EXPECT_EQ(solver->advance().substeps, viscous) << "frame " << frame;
}

}  // namespace
}  // namespace squall::test
