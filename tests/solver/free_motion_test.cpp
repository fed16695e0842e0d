// Motions that are known exactly: one particle, two, none; a block that falls; what internal forces may not change.
#include <cmath>
#include <string>

#include "core/scene.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

class FreeMotion : public OnEveryBackend {
 protected:
  /// Slope of pressure over density, p/rho0 per relative density. dfsph removes an error of the density within a
  /// sub-step, by pressure of up to dx^2/dt^2 times the error.
  double stiffness_of(const Scene& scene, double dt) const {
    const double dx = scene.fluid.spacing_m;
    if (GetParam().settings.pressure == Pressure::dfsph) return dx * dx / (dt * dt);
    return GetParam().settings.pressure == Pressure::wcsph ? std::pow(scene.speed_of_sound(), 2)
                                                           : scene.solver.stiffness_m2_s2;
  }
};
SQUALL_ON_EVERY_BACKEND(FreeMotion);

// Staggered leap-frog follows a parabola exactly: x = x0 + v0 t + g t^2/2 at the end of every frame. What rounding
// leaves: half a last bit of x and of v in each sub-step, the latter drifting on.
TEST_P(FreeMotion, OneParticleFollowsItsParabola) {
  Particles one;
  one.add(0, {0.3125, 0.5, 0.1875}, {0.5, 1.0, -0.125});
  const Scene scene = tank_with(one);
  const auto solver = make(scene);
  int substeps = 0;
  for (int frame = 1; frame <= 12; ++frame) {
    substeps += solver->advance().substeps;
    const double t = frame / 60.0;
    const Eigen::Vector3d exact = one.positions[0] + t * one.velocities[0] + t * t / 2 * scene.gravity_m_s2;
    const Eigen::Vector3d x = solver->state().particles.positions.at(0);
    const double tolerance = rounding(substeps, 1.0) + rounding(substeps, 3.0) * t;
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(x[axis], exact[axis], tolerance) << "frame " << frame;
  }
}

// Velocities delivered belong to the middle of the last sub-step.
TEST_P(FreeMotion, DeliveredVelocitiesAreHalfAStepBehind) {
  Particles one;
  one.add(0, {0.3125, 0.5, 0.1875}, {0.5, 1.0, -0.125});
  const auto solver = make(tank_with(one));
  const FrameReport& report = solver->advance();
  const double t = 1.0 / 60 - report.dt_s / 2;
  EXPECT_NEAR(solver->state().particles.velocities.at(0).y(), 1.0 - 9.81 * t, rounding(report.substeps + 2, 1.0));
}

// A lattice has rest density and no pressure but what rounding makes of it: n eps of density is 7 B n eps (Tait; k n
// eps for mueller) of pressure, over a spacing, twice for two neighbours; n = 40 terms of a sum.
TEST_P(FreeMotion, AFallingBlockStaysRigid) {
  const Scene scene = load_scene(SQUALL_SCENES_DIR "/free_fall.toml");
  const auto start = by_id(initial_particles(scene));
  const auto solver = make(scene);
  int substeps = 0, frames = 6;
  for (int frame = 0; frame < frames; ++frame) substeps += solver->advance().substeps;
  const double t = frames / scene.time.frame_rate_hz;
  const double push = 2 * rounding(40, stiffness_of(scene, t / substeps)) / scene.fluid.spacing_m;
  const double tolerance = push * t * t / 2 + rounding(substeps, 1.0) + rounding(substeps, 1.0) * t;
  const Particles now = solver->state().particles;
  ASSERT_EQ(now.size(), 1000u);
  for (const auto& [id, motion] : by_id(now)) {
    const Eigen::Vector3d exact = start.at(id).position + t * t / 2 * scene.gravity_m_s2;
    ASSERT_LE((motion.position - exact).norm(), tolerance) << "id " << id;
  }
  if (!GetParam().is_single()) {
    EXPECT_LT(tolerance, 1e-5 * scene.fluid.spacing_m);
  }
}

struct Momenta {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
};

Momenta momenta(const Particles& particles) {
  Momenta sum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    sum.linear += particles.velocities[i];
    sum.angular += particles.positions[i].cross(particles.velocities[i]);
  }
  return sum;
}

// Internal forces add up to nothing: a compressed, stirred lump far from walls keeps its momentum to the rounding of
// its accelerations (about 60 operations each) and, if its forces are central as mueller's are not, its angular
// momentum, to that times the distance from the origin (below 2 m) and what rounding of the positions adds.
TEST_P(FreeMotion, ALumpKeepsItsMomentum) {
  const int edge = 8, count = edge * edge * edge;
  const Particles lump = shaken_lattice(edge, 0.045, {0.25, 0.15, 0.1}, 0.003, 0.3, 3);
  Scene scene = tank_with(lump);
  scene.gravity_m_s2.setZero();
  scene.solver.speed_of_sound_m_s = 10;
  scene.container.min_m = {-0.6, -0.6, -0.6};
  scene.container.max_m = {1.4, 1.4, 1.4};
  const auto solver = make(scene);
  const Momenta before = momenta(solver->state().particles);
  double impulse = 0, way = 0;
  for (int frame = 0; frame < 3; ++frame) {
    const FrameReport& report = solver->advance();
    ASSERT_EQ(report.clamps, 0);
    impulse += report.max_acceleration / 60;
    way += report.substeps * report.max_speed;
  }
  EXPECT_GT(impulse, 0.5) << "nothing happened that could change a momentum";
  const Momenta after = momenta(solver->state().particles);
  EXPECT_LE((after.linear - before.linear).norm(), rounding(60, count * impulse));
  if (GetParam().settings.pressure != Pressure::mueller) {
    EXPECT_LE((after.angular - before.angular).norm(),
              rounding(60, 2 * count * impulse) + rounding(1, 2 * count * way));
  }
}

TEST_P(FreeMotion, NoParticlesRunWell) {
  const auto solver = make(empty_tank());
  for (int frame = 0; frame < 20; ++frame) {
    const FrameReport& report = solver->advance();
    EXPECT_EQ(report.particles, 0);
    EXPECT_EQ(report.active, 0);
    EXPECT_EQ(report.density_error_mean, 0);
    EXPECT_EQ(report.neighbours_mean, 0);
    EXPECT_GE(report.substeps, 1);
  }
  EXPECT_EQ(solver->positions().count, 0u);
  EXPECT_EQ(solver->state().particles.size(), 0u);
}

TEST_P(FreeMotion, OneAndTwoParticlesRunWell) {
  for (const std::size_t count : {1u, 2u}) {
    const auto solver = make(tank_with(random_particles(count, {0.3, 0.2, 0.2}, {0.35, 0.25, 0.2001}, 1, 8)));
    int substeps = 0;
    while (substeps < 100) substeps += solver->advance().substeps;
    const FrameReport& report = solver->report();
    EXPECT_EQ(report.particles, static_cast<std::int64_t>(count));
    EXPECT_EQ(report.lost, 0);
    EXPECT_EQ(solver->positions().count, count);
    EXPECT_TRUE(all_finite(solver->state().particles));
  }
}

}  // namespace
}  // namespace squall::test
