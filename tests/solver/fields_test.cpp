// What solvers say of single particles: densities, pressures and neighbours of the last sub-step.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/frame_plan.h"
#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

class FieldsOfParticles : public OnEveryBackend {
 protected:
  static constexpr std::size_t k_count = 300;

  /// Too dense a cloud, so that all pressure solvers have something to push.
  static Particles cloud() { return random_particles(k_count, {0.2, 0.05, 0.1}, {0.5, 0.25, 0.3}, 0.2, 11); }
  std::unique_ptr<Solver> started() const {
    auto solver = make(one_substep_tank(k_count));
    solver->load(cloud());
    return solver;
  }
};
SQUALL_ON_EVERY_BACKEND(FieldsOfParticles);

TEST_P(FieldsOfParticles, NeighboursAreThoseWithinReachAndAllAgreesWithTheReport) {
  const auto solver = started();
  const Particles before = cloud();  // ids are indices
  const FrameReport report = solver->advance();
  const Particles after = solver->state().particles;
  const Fields fields = solver->fields();
  ASSERT_EQ(fields.neighbours.size(), k_count);
  ASSERT_EQ(fields.densities.size(), k_count);
  const double largest = *std::max_element(fields.densities.begin(), fields.densities.end());
  EXPECT_NEAR(largest - 1.0, report.density_error_max, rounding(2, largest));
  const double neighbours = std::accumulate(fields.neighbours.begin(), fields.neighbours.end(), 0.0);
  EXPECT_DOUBLE_EQ(neighbours / static_cast<double>(report.active), report.neighbours_mean);
  const double reach = solver->scene().support_radius();
  // Positions lie on single-precision numbers; a distance may be off by a few roundings.
  const double margin = 8.0 * std::numeric_limits<float>::epsilon() * reach;
  for (std::size_t i = 0; i < k_count; ++i) {
    int least = -1, most = -1;  // without self
    for (const auto& position : before.positions) {
      const double distance = (position - before.positions[after.ids[i]]).norm();
      least += distance < reach - margin;
      most += distance < reach + margin;
    }
    ASSERT_GE(fields.neighbours[i], least) << "particle " << after.ids[i];
    ASSERT_LE(fields.neighbours[i], most) << "particle " << after.ids[i];
  }
}

TEST_P(FieldsOfParticles, PressuresAreThoseOfTheDensities) {
  const auto solver = started();
  solver->advance();
  const Fields fields = solver->fields();
  const Pressure pressure = GetParam().settings.pressure;
  const Params<double> p = make_params(solver->scene(), pressure);
  const Particles after = solver->state().particles;
  double largest = 0.0;
  for (std::size_t i = 0; i < fields.pressures.size(); ++i) {
    const double density = fields.densities[i];
    largest = std::max(largest, fields.pressures[i]);
    double expected = 0.0, slope = 0.0;  // slope: how a rounding of the density shows in the pressure
    if (pressure == Pressure::dfsph) {
      expected = after.pressures[i];
    } else if (pressure == Pressure::wcsph) {
      expected = std::max(0.0, p.stiffness * (std::pow(density, 7) - 1.0));
      slope = 7.0 * p.stiffness * std::pow(density, 7);
    } else {
      expected = std::max(0.0, p.stiffness * (density - 1.0));
      slope = p.stiffness * density;
    }
    ASSERT_NEAR(fields.pressures[i], expected, rounding(16, expected + slope)) << "density " << density;
  }
  EXPECT_GT(largest, 0.0);
}

TEST(FieldsOfAnySolver, ThereAreNoneBeforeASubstep) {
  const auto solver = make_solver("reference", test::filled_tank(2), Settings{});
  EXPECT_TRUE(solver->fields().densities.empty());
  solver->advance();
  EXPECT_FALSE(solver->fields().densities.empty());
  solver->restore(solver->state());
  EXPECT_TRUE(solver->fields().densities.empty());
}

TEST_P(FieldsOfParticles, NeighboursAreNotCountedWithoutStatistics) {
  BackendUnderTest quiet = GetParam();
  quiet.settings.statistics = false;
  const auto solver = quiet.make(one_substep_tank(k_count));
  solver->load(cloud());
  solver->advance();
  EXPECT_EQ(solver->fields().densities.size(), k_count);
  EXPECT_TRUE(solver->fields().neighbours.empty());
}

}  // namespace
}  // namespace squall::test
