// One sub-step of every backend against the reference in double, and neighbours against brute force.
#include <cmath>

#include "grid.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

class Forces : public OnEveryBackend {
 protected:
  /// The largest |velocity - reference| after one sub-step, the reference being double precision.
  void expect_one_substep_like_reference(Scene scene, const Particles& particles) {
    if (GetParam().settings.pressure == Pressure::dfsph) {  // as many iterations in every precision
      scene.solver.max_iterations = 2;
      scene.solver.density_tolerance = scene.solver.divergence_tolerance = 1e-7;
    }
    const auto solver = make(scene);
    const auto reference = test::reference(Precision::double_precision, GetParam().settings.pressure).make(scene);
    solver->load(particles);
    reference->load(particles);
    const FrameReport& report = solver->advance();
    const FrameReport& expected = reference->advance();
    ASSERT_EQ(report.substeps, 1);
    ASSERT_EQ(expected.substeps, 1);
    const double tolerance = acceleration_tolerance(scene, expected) * report.dt_s;
    const auto exact = by_id(reference->state().particles);
    double worst = 0;
    for (const auto& [id, motion] : by_id(solver->state().particles))
      worst = std::max(worst, (motion.velocity - exact.at(id).velocity).norm());
    EXPECT_LE(worst, tolerance) << "accelerations up to " << expected.max_acceleration << " m/s^2";
    EXPECT_NEAR(report.density_error_max, expected.density_error_max,
                rounding(neighbours(expected), 1 + expected.density_error_max));
    // A backend may sum up errors in units of 2^-32, each rounded to the nearest.
    EXPECT_NEAR(report.density_error_mean, expected.density_error_mean,
                rounding(neighbours(expected), 1 + expected.density_error_max) + std::ldexp(1.0, -33));
    EXPECT_NEAR(report.max_acceleration, expected.max_acceleration, tolerance / report.dt_s);
    EXPECT_NEAR(report.max_speed, expected.max_speed, tolerance + rounding(4, expected.max_speed));
  }

  /// Terms of a sum, generously: twice the mean, and what a term itself rounds.
  static double neighbours(const FrameReport& report) { return 2 * report.neighbours_mean + 16; }

  /// A density of n terms is off by n eps rho, its pressure by the slope of the equation of state times that; the force
  /// of up to n pairs over a distance H/4 passes this on, and adds n eps of itself. dfsph removes the error of a
  /// density by pressure of up to dx^2/dt^2 times it, in two iterations of either solve.
  double acceleration_tolerance(const Scene& scene, const FrameReport& expected) const {
    const double density = 1 + expected.density_error_max;
    const double slope =
        GetParam().settings.pressure == Pressure::wcsph   ? std::pow(scene.speed_of_sound(), 2) * std::pow(density, 6)
        : GetParam().settings.pressure == Pressure::dfsph ? 4 * std::pow(scene.fluid.spacing_m / expected.dt_s, 2)
                                                          : scene.solver.stiffness_m2_s2;
    const double n = neighbours(expected);
    return rounding(n, slope * density) / (scene.support_radius() / 4) + rounding(n, expected.max_acceleration);
  }
};
SQUALL_ON_EVERY_BACKEND(Forces);

TEST_P(Forces, RandomParticlesAmongWallsAreLikeReference) {
  for (const std::size_t count : {1u, 2u, 63u, 64u, 65u, 1000u, 2049u}) {
    SCOPED_TRACE(count);
    const Scene scene = one_substep_tank(count);
    expect_one_substep_like_reference(scene, random_particles(count, {0.01, 0.01, 0.01}, {0.79, 0.59, 0.39}, 0.3, 4));
  }
}

TEST_P(Forces, ParticlesAroundBoxesAreLikeReference) {
  Scene scene = one_substep_tank(1500);
  scene.particle_files.clear();
  scene.boxes = {{{0.2, 0.1, 0.1}, {0.225, 0.5, 0.3}, std::nullopt},
                 {{0.5, 0.0, 0.0}, {0.65, 0.15, 0.4}, std::nullopt}};
  Scene::Block room;  // for the particles that are loaded below
  room.min_m = {0.25, 0.15, 0};
  room.max_m = {0.8, 0.6, 0.4};
  scene.blocks = {room};
  std::size_t placed = 0;
  Particles particles;
  const Particles candidates = random_particles(2000, {0.01, 0.01, 0.01}, {0.79, 0.59, 0.39}, 0.3, 5);
  for (std::size_t i = 0; i < candidates.size() && placed < static_cast<std::size_t>(particle_capacity(scene)); ++i) {
    const Eigen::Vector3d& x = candidates.positions[i];
    const bool inside = std::any_of(scene.boxes.begin(), scene.boxes.end(), [&](const Scene::SolidBox& box) {
      return Eigen::AlignedBox3d(box.min_m, box.max_m).exteriorDistance(x) < 1e-3;
    });
    if (!inside) particles.add(static_cast<std::uint32_t>(placed++), x, candidates.velocities[i]);
  }
  ASSERT_GT(placed, 500u);
  expect_one_substep_like_reference(scene, particles);
}

// Neighbours counted by brute force, the random positions being no closer to H than rounding could decide. Includes the
// first and last cell of every axis, and particles that start outside the container, where coordinates are negative.
TEST_P(Forces, NeighboursAreThoseOfBruteForce) {
  const Scene scene = one_substep_tank(1025);
  const double support = scene.support_radius();
  for (const auto& [low, high] :
       std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>{{{0, 0, 0}, {0.8, 0.6, 0.4}},
                                                                {{-0.15, -0.12, -0.11}, {0.1, 0.1, 0.1}},
                                                                {{0.7, 0.5, 0.3}, {0.95, 0.72, 0.5}}}) {
    Particles particles = random_particles(1025, low, high, 0, 6);
    const auto solver = make(scene);
    solver->load(particles);
    std::int64_t pairs = 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double r = (particles.positions[i] - particles.positions[j]).norm();
        ASSERT_GT(std::abs(r - support), rounding(4, support)) << "too close to tell; choose another seed";
        pairs += r < support;
      }
    const FrameReport& report = solver->advance();
    ASSERT_EQ(report.substeps, 1);
    EXPECT_EQ(std::llround(report.neighbours_mean * 1025), 2 * pairs);
  }
}

// Everything in one cell: a list of 1,024 neighbours for every particle; nothing has a fixed capacity.
TEST_P(Forces, AllParticlesInOneCell) {
  const Scene scene = one_substep_tank(1025);
  const double edge = scene.support_radius();
  const Eigen::Vector3d corner(2 * edge, 2 * edge, edge);
  const Particles particles = random_particles(1025, corner + Eigen::Vector3d::Constant(0.01 * edge),
                                               corner + Eigen::Vector3d::Constant(0.45 * edge), 0, 7);
  const auto solver = make(scene);
  solver->load(particles);
  const FrameReport report = solver->advance();
  EXPECT_EQ(report.neighbours_mean, 1024);
  const auto reference = test::reference(Precision::double_precision, GetParam().settings.pressure).make(scene);
  reference->load(particles);
  const double expected = reference->advance().density_error_max;
  EXPECT_GT(expected, 30);
  EXPECT_NEAR(report.density_error_max, expected, rounding(1025 + 16, expected));
  EXPECT_TRUE(all_finite(solver->state().particles));
}

// The order after a sub-step is a stable sort by cell of the order before it.
TEST_P(Forces, TheOrderIsAStableSortByCell) {
  const int edge = 13;
  Scene scene = one_substep_tank(edge * edge * edge);
  scene.container.max_m = {0.8, 0.8, 0.8};
  scene.solver.speed_of_sound_m_s = 5;
  const auto solver = make(scene);
  solver->load(shaken_lattice(edge, 0.055, {0.06, 0.06, 0.06}, 0.01, 3, 9));
  const Params<float> params = to_single(make_params(scene, GetParam().settings.pressure));
  const Params<double> wide_params = make_params(scene, GetParam().settings.pressure);
  int moved = 0;
  for (int frame = 0; frame < 5; ++frame) {
    const Particles before = solver->state().particles;
    std::vector<std::pair<int, std::uint32_t>> expected;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Eigen::Vector3d& x = before.positions[i];
      const Eigen::Vector3f single = x.cast<float>();
      expected.emplace_back(GetParam().is_single() ? cell_of(&params, single.x(), single.y(), single.z())
                                                   : cell_of(&wide_params, x.x(), x.y(), x.z()),
                            before.ids[i]);
    }
    std::stable_sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    ASSERT_EQ(solver->advance().substeps, 1);
    const Particles after = solver->state().particles;
    ASSERT_EQ(after.size(), before.size());
    moved += after.ids != before.ids;
    for (std::size_t i = 0; i < after.size(); ++i) ASSERT_EQ(after.ids[i], expected[i].second) << "place " << i;
  }
  EXPECT_EQ(moved, 5) << "the order never changed";
}

// Twins at the support radius, next to it and at the knot of the spline: relative motion is changed by viscosity alone,
// by what the kernel's slope is there; at H exactly by next to nothing.
TEST_P(Forces, PairsAtTheEndsOfTheKernelAreLikeReference) {
  Scene scene = one_substep_tank(2);
  scene.fluid.viscosity_m2_s = 0.1;
  scene.gravity_m_s2.setZero();
  const double support = scene.support_radius();
  const auto pair_at = [&](double r) {
    Particles pair;
    pair.add(0, {0.25, 0.25, 0.25}, {1, 0, 0});
    pair.add(1, {0.25 + r, 0.25, 0.25}, {-1, 0, 0});
    return pair;
  };
  for (const double r : {support, support * (1 - 1e-7), support / 2, support / 4}) {
    SCOPED_TRACE(r / support);
    expect_one_substep_like_reference(scene, pair_at(r));
  }
  // Slope of the kernel at u = 1 - r/H: at most u for either pressure solver, and u itself is no more than a rounding
  // of r = 0.35 - 0.25, twice that for 1/H and the product.
  const auto solver = make(scene);
  solver->load(pair_at(support));
  solver->advance();
  const double u = rounding(8, 1.0);
  const double strength = 10 * 0.1 * 45 / 3.14 * std::pow(0.5, 3) / (support * support) * 2 * 10;
  for (const auto& velocity : solver->state().particles.velocities)
    EXPECT_NEAR(std::abs(velocity.x()), 1, strength * u * solver->report().dt_s + rounding(2, 1));
}

}  // namespace
}  // namespace squall::test
