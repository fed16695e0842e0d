// The operators of the pressure solve against what they are by definition: the rate against the density's own finite
// differences, the push as the rate's adjoint, the response as the diagonal of both.
#include "core/reference_dfsph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/frame_plan.h"
#include "support/numbers.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

using reference::Particle;
using reference::SortedParticles;

/// A stirred lattice in a tank with an obstacle, water against every wall.
class Operators : public testing::Test {
 protected:
  Operators() {
    scene_.boxes = {{{0.32, 0.0, 0.12}, {0.48, 0.18, 0.28}, std::nullopt}};
    p_ = make_params(scene_, Pressure::dfsph);
    boxes_ = make_boxes(scene_, Pressure::dfsph);
    walls_ = {boxes_.data(), 1};
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (double x = 0.025; x < 0.8; x += 0.05)
      for (double y = 0.025; y < 0.3; y += 0.05)
        for (double z = 0.025; z < 0.4; z += 0.05) {
          if (x > 0.3 && x < 0.5 && y < 0.2 && z > 0.1 && z < 0.3) continue;
          Particle<double> particle;
          const double at[3] = {x, y, z};
          particle.id = static_cast<std::uint32_t>(sorted_.particles.size());
          for (int axis = 0; axis < 3; ++axis) {
            particle.x[axis] = at[axis] + 0.02 * unit(random);
            particle.v[axis] = unit(random);
          }
          particle.change = unit(random);
          sorted_.particles.push_back(particle);
        }
    sort(p_, {}, 0, sorted_);
    for (int i = 0; i < count(); ++i) prepare(p_, walls_, sorted_, i);
  }

  int count() const { return static_cast<int>(sorted_.particles.size()); }
  Particle<double>& at(int i) { return sorted_.particles[static_cast<std::size_t>(i)]; }

  /// Densities after a time at the velocities as they are; the order stays, for moves much shorter than a cell.
  std::vector<double> densities_after(double time) {
    SortedParticles<double> moved = sorted_;
    for (auto& particle : moved.particles)
      for (int axis = 0; axis < 3; ++axis) particle.x[axis] += time * particle.v[axis];
    sort(p_, {}, 0, moved);
    for (int i = 0; i < count(); ++i) prepare(p_, walls_, moved, i);
    std::vector<double> densities(moved.particles.size());
    for (const auto& particle : moved.particles) densities[particle.id] = particle.density;
    return densities;
  }

  Scene scene_ = empty_tank();
  Params<double> p_{};
  std::vector<Box<double>> boxes_;
  reference::Walls<double> walls_;
  SortedParticles<double> sorted_;
};

// A central difference over 2 h is off by h^2/6 times third derivatives of 40 kernels along speeds of up to 2 sqrt(3),
// each below 200/H^3; by the jumps of the spline's third derivative and of the cores' second (2 core_share/reach^2, at
// speed^2); and by the rounding of two densities.
TEST_F(Operators, RateIsTheDensitysOwn) {
  constexpr double h = 1e-7;
  const double speed = 2 * std::sqrt(3.0), reach = 1 / p_.inverse_core_reach;
  const double third = 40 * 200 * std::pow(speed / p_.support_radius, 3);
  const double tolerance =
      third * h * h / 6 + 3 * 2 * p_.core_share * std::pow(speed / reach, 2) * h + rounding<double>(80, 1 / h);
  const auto before = densities_after(-h), after = densities_after(h);
  double largest = 0;
  for (int i = 0; i < count(); ++i) {
    const double rate = compression_rate_of(p_, sorted_, i);
    ASSERT_NEAR(rate, (after[at(i).id] - before[at(i).id]) / (2 * h), tolerance) << at(i).x[0] << " " << at(i).x[1];
    largest = std::max(largest, std::abs(rate));
  }
  EXPECT_GT(largest, 1e4 * tolerance) << "nothing was compressed";
}

// sum_i j_i D_i(v) = - sum_i v_i.(what impulses j add to v_i): to the rounding of two sums of count x 60 terms. This is
// what keeps pressure from doing work of its own, walls and boxes included.
TEST_F(Operators, PushIsTheAdjointOfTheRate) {
  double work = 0, scale = 0;
  for (int i = 0; i < count(); ++i) {
    const double term = at(i).change * compression_rate_of(p_, sorted_, i);
    work += term;
    scale += std::abs(term);
  }
  double other = 0;
  const SortedParticles<double> before = sorted_;
  for (int i = 0; i < count(); ++i) push(p_, sorted_, i);
  for (int i = 0; i < count(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double v = before.particles[static_cast<std::size_t>(i)].v[axis];
      const double term = v * (at(i).v[axis] - v);
      other += term;
      scale += std::abs(term);
    }
  EXPECT_NEAR(work, -other, rounding<double>(60, scale));
  EXPECT_GT(std::abs(work), 1e-4 * scale) << "too little happened to tell";
}

// One particle's impulse changes its own rate by minus its response; relative to what the rate is made of.
TEST_F(Operators, ResponseIsTheDiagonal) {
  for (const int i : {0, 1, count() / 3, count() / 2, count() - 1}) {
    SortedParticles<double> one = sorted_;
    for (auto& particle : one.particles) {
      std::fill(particle.v, particle.v + 3, 0.0);
      particle.change = 0;
    }
    one.particles[static_cast<std::size_t>(i)].change = 1;
    for (int j = 0; j < count(); ++j) push(p_, one, j);
    const double response = at(i).response;
    EXPECT_GT(response * p_.support_squared, 1e-3);
    EXPECT_NEAR(compression_rate_of(p_, one, i), -response, rounding<double>(100, response));
    EXPECT_NEAR(response * at(i).inverse_response, 1, rounding<double>(4) + p_.response_guard / (response * response));
  }
}

// All impulses within the fluid cancel: what all particles gain together is what walls give, and far from walls
// nothing.
TEST_F(Operators, PushKeepsMomentumButForWalls) {
  for (auto& particle : sorted_.particles)
    for (int axis = 0; axis < 3; ++axis) particle.descent[axis] -= particle.opening_gradient[axis];
  double gained[3] = {}, scale = 0;
  const SortedParticles<double> before = sorted_;
  for (int i = 0; i < count(); ++i) push(p_, sorted_, i);
  for (int i = 0; i < count(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double change = at(i).v[axis] - before.particles[static_cast<std::size_t>(i)].v[axis];
      gained[axis] += change;
      scale += std::abs(change) + 1;
    }
  for (const double gain : gained) EXPECT_NEAR(gain, 0, rounding<double>(60, scale));
}

// A particle that has nobody: no response, and pressure leaves it alone, whatever is asked of it.
TEST(LoneParticle, HasNoPressure) {
  const Scene scene = empty_tank();
  const auto p = make_params(scene, Pressure::dfsph);
  SortedParticles<double> sorted;
  Particle<double> particle;
  const double at[3] = {0.4, 0.3, 0.2};
  std::copy(at, at + 3, particle.x);
  particle.v[0] = 3;
  sorted.particles.push_back(particle);
  sort(p, {}, 0, sorted);
  prepare(p, reference::Walls<double>{}, sorted, 0);
  EXPECT_EQ(sorted.particles[0].response, 0);
  EXPECT_EQ(sorted.particles[0].inverse_response, 0);
  EXPECT_EQ(compression_rate_of(p, sorted, 0), 0);
  EXPECT_EQ(sorted.particles[0].isolation, 1);
}

}  // namespace
}  // namespace squall::test
