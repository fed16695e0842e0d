#include "core/positions_view.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace squall {
namespace {

TEST(PositionsView, FindsFloatsByTheirStride) {
  const std::array<float, 16> records{1, 2, 3, 99, 99, 99, 99, 99, 4, 5, 6, 99, 99, 99, 99, 99};
  const PositionsView view{records.data(), PositionFormat::float32, 8 * sizeof(float), 2};
  EXPECT_EQ(view.position(0), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(view.position(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_FALSE(view.lost(1));
  EXPECT_EQ(view.position_bytes(), 12u);
  EXPECT_EQ(view.error_bound(), Eigen::Vector3f::Zero());
}

TEST(PositionsView, DecodesSixteenBits) {
  const std::array<std::uint16_t, 9> codes{0, 1, 65534, 4, 8, 16, k_lost_code, k_lost_code, k_lost_code};
  PositionsView view{codes.data(), PositionFormat::unorm16, 6, 3};
  view.offset = {1.0f, 0.0f, -1.0f};
  view.scale = {0.5f, 0.25f, 0.125f};
  // Powers of two: nothing rounds.
  EXPECT_EQ(view.position(0), Eigen::Vector3f(1.0f, 0.25f, 8190.75f));
  EXPECT_EQ(view.position(1), Eigen::Vector3f(3.0f, 2.0f, 1.0f));
  EXPECT_EQ(view.position(2), Eigen::Vector3f::Constant(1e30f));
  EXPECT_FALSE(view.lost(0));
  EXPECT_TRUE(view.lost(2));
  EXPECT_EQ(view.position_bytes(), 6u);
}

TEST(PositionsView, BoundsTheErrorOfSixteenBits) {
  PositionsView view;
  view.format = PositionFormat::unorm16;
  view.scale = {0.5f, 0.25f, 0.125f};
  const double roundings = 3 * 65534 * std::ldexp(1.0, -24);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(view.error_bound()[axis], (0.5 + roundings) * static_cast<double>(view.scale[axis]));
    EXPECT_LE(view.error_bound()[axis], 0.52 * static_cast<double>(view.scale[axis]));
  }
}

TEST(PositionsView, KnowsLostParticles) {
  const std::array<float, 3> lost{1e30f, 1e30f, 1e30f};
  EXPECT_TRUE((PositionsView{lost.data(), PositionFormat::float32, 12, 1}.lost(0)));
}

}  // namespace
}  // namespace squall
