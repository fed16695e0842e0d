#include "bench_support/cases.h"

#include <gtest/gtest.h>

#include <set>

#include "harness/measures.h"

namespace squall::bench {
namespace {

TEST(SplitParticles, FillTheCubeThatAParticleIs) {
  Particles one;
  one.add(5, {0.5, 0.6, 0.7}, {1, 2, 3});
  const Particles children = split_particles(one, 2, 0.1, {10, 10, 10}, 0.01);
  ASSERT_EQ(children.size(), 8u);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 8; ++i) {
    centre += children.positions[i] / 8;
    EXPECT_EQ(children.velocities[i], one.velocities[0]);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::abs(children.positions[i][axis] - one.positions[0][axis]), 0.025, 1e-15);
  }
  EXPECT_LT((centre - one.positions[0]).norm(), 1e-14);
  EXPECT_EQ(std::set<std::uint32_t>(children.ids.begin(), children.ids.end()).size(), 8u);
}

TEST(SplitParticles, StayInsideTheContainer) {
  Particles one;
  one.add(0, {0.001, 0.999, 0.5}, {0, 0, 0});
  for (const auto& x : split_particles(one, 3, 0.1, {1, 1, 1}, 0.01).positions) {
    EXPECT_GE(x.minCoeff(), 0.01);
    EXPECT_LE(x.maxCoeff(), 0.99);
  }
  EXPECT_EQ(split_particles(one, 1, 0.1, {1, 1, 1}, 0.0).positions[0], one.positions[0]);
}

TEST(Cases, HaveTheirSizeAndAreMadeOnce) {
  Cases cases(Effort::smoke);
  for (const Size size : {Size{6, 1}, Size{3, 2}}) {
    const Case& made = cases.get(Pressure::wcsph, size);
    EXPECT_EQ(made.state.particles.size(), 432u);
    EXPECT_EQ(made.active, 432);
    EXPECT_TRUE(harness::is_finite(made.state.particles));
    EXPECT_GT(made.neighbours_mean, 10.0);
    EXPECT_EQ(&cases.get(Pressure::wcsph, size), &made);
  }
}

TEST(Cases, SizesNameTheirParticles) {
  EXPECT_EQ(sizes_for(Effort::full).back().particles(), 1'024'000);
  EXPECT_EQ(sizes_for(Effort::quick).front().particles(), 11'664);
  EXPECT_EQ(case_name(Pressure::mueller, {18, 2}), "mueller/93312");
}

}  // namespace
}  // namespace squall::bench
