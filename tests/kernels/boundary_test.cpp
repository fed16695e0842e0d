// The safety net: clamps at the container's faces, solid boxes however thin and particles however fast, what is lost.
#include "boundary.h"
#include "grid.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <vector>

#include "kernels/wall_params.h"
#include "support/numbers.h"

namespace squall::test {
namespace {

template <class Real>
class Boundary : public testing::Test {
 protected:
  using Vector = std::array<Real, 3>;

  Boundary() : params_(container_params<Real>(4, 2, 1, 0.5)) { params_.clamp_distance = edge_; }

  Box<Real> box(const Vector& low, const Vector& high) {
    Box<Real> box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.solid_min[axis] = low[axis];
      box.solid_max[axis] = high[axis];
    }
    return box;
  }

  int keep(const Vector& from, Vector* x, Vector* v) {
    return keep_inside(&params_, boxes_.data(), static_cast<int>(boxes_.size()), from.data(), x->data(), v->data());
  }

  const Real edge_ = Real(0.0078125);  // 2^-7: sums with it are exact
  Params<Real> params_;
  std::vector<Box<Real>> boxes_;
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Boundary, Reals);

TYPED_TEST(Boundary, LeavesAloneWhatIsInside) {
  using Vector = typename TestFixture::Vector;
  for (const Vector& inside : {Vector{2, 1, 0.5}, Vector{this->edge_, this->edge_, this->edge_},
                               Vector{4 - this->edge_, 2 - this->edge_, 1 - this->edge_}}) {
    Vector x = inside, v = {-9, 9, -9};
    EXPECT_TRUE(is_inside_container(&this->params_, x.data()));
    EXPECT_EQ(this->keep({2, 1, 0.5}, &x, &v), 0);
    EXPECT_EQ(x, inside);
    EXPECT_EQ(v, (Vector{-9, 9, -9}));
  }
}

// A tenth of a spacing, a spacing and far outside; exactly on the plane; below the floor.
TYPED_TEST(Boundary, PutsBackWhatLeftAndStopsOnlyTheMotionOutward) {
  using Real = TypeParam;
  using Vector = typename TestFixture::Vector;
  const Vector size = {4, 2, 1};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Real out : {Real(0), Real(0.025), Real(0.25), Real(15)})
      for (const bool high : {false, true}) {
        SCOPED_TRACE(testing::Message() << "axis " << axis << ", out by " << out << (high ? ", high" : ", low"));
        Vector x = {2, 1, 0.5}, v = {0.5, -0.25, 0.125};
        x[axis] = high ? size[axis] + out : -out;
        v[axis] = high ? Real(3) : Real(-3);
        const Vector from = {2, 1, 0.5};
        Vector expected_x = x, expected_v = v;
        expected_x[axis] = high ? size[axis] - this->edge_ : this->edge_;
        expected_v[axis] = 0;
        EXPECT_EQ(this->keep(from, &x, &v), SQUALL_CLAMPED);
        EXPECT_EQ(x, expected_x);
        EXPECT_EQ(v, expected_v);

        // on its way back already: nothing to stop
        x[axis] = high ? size[axis] + out : -out;
        v[axis] = high ? Real(-3) : Real(3);
        EXPECT_EQ(this->keep(from, &x, &v), SQUALL_CLAMPED);
        EXPECT_EQ(v[axis], high ? Real(-3) : Real(3));
      }
}

TYPED_TEST(Boundary, CornersClampOnEveryAxis) {
  using Vector = typename TestFixture::Vector;
  Vector x = {-1, -1, 2}, v = {-1, -2, 3};
  EXPECT_EQ(this->keep({2, 1, 0.5}, &x, &v), SQUALL_CLAMPED);
  EXPECT_EQ(x, (Vector{this->edge_, this->edge_, 1 - this->edge_}));
  EXPECT_EQ(v, (Vector{0, 0, 0}));
}

TYPED_TEST(Boundary, AnOpenTopLetsPassUpToTheLostDistance) {
  using Vector = typename TestFixture::Vector;
  this->params_.lid = 0;
  Vector x = {2, 15, 0.5}, v = {0, 9, 0};
  EXPECT_TRUE(is_inside_container(&this->params_, x.data()));
  EXPECT_EQ(this->keep({2, 1, 0.5}, &x, &v), 0);
  EXPECT_EQ(x[1], 15);
  // the side walls reach upward without end
  x = {5, 15, 0.5};
  EXPECT_FALSE(is_inside_container(&this->params_, x.data()));
  EXPECT_EQ(this->keep({2, 1, 0.5}, &x, &v), SQUALL_CLAMPED);
  EXPECT_EQ(x, (Vector{4 - this->edge_, 15, 0.5}));
}

TYPED_TEST(Boundary, MarksWhatIsNotFiniteOrFarAway) {
  using Real = TypeParam;
  using Vector = typename TestFixture::Vector;
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
  const Real far = std::nextafter(this->params_.lost_distance, infinity);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Real bad : {nan, -nan, infinity, -infinity, Real(1e38), Real(-1e38), -far, Real(5) + far}) {
      SCOPED_TRACE(testing::Message() << "axis " << axis << ", " << bad);
      Vector x = {2, 1, 0.5}, v = {1, nan, 1};
      x[axis] = bad;
      EXPECT_FALSE(is_inside_container(&this->params_, x.data()));
      EXPECT_EQ(this->keep({2, 1, 0.5}, &x, &v), SQUALL_LOST);
      EXPECT_TRUE(is_lost(x[0]) && is_lost(x[1]) && is_lost(x[2]));
      EXPECT_EQ(v, (Vector{0, 0, 0}));
    }
  Vector x = {-this->params_.lost_distance, 1, 0.5}, v = {0, 0, 0};
  EXPECT_EQ(this->keep({2, 1, 0.5}, &x, &v), SQUALL_CLAMPED) << "the lost distance itself is kept";
}

// From every side, at speeds that cross a box of 1/64 in less than a thousandth of the step.
TYPED_TEST(Boundary, NothingTunnelsThroughAThinBox) {
  using Real = TypeParam;
  using Vector = typename TestFixture::Vector;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector low = {0, 0, 0}, high = {4, 2, 1};
    low[axis] = Real(0.5);
    high[axis] = Real(0.515625);
    this->boxes_ = {this->box(low, high)};
    for (const bool upward : {true, false}) {
      SCOPED_TRACE(testing::Message() << "axis " << axis << (upward ? ", upward" : ", downward"));
      Vector from = {1, 1, 0.25}, x = {1.5, 0.75, 0.75}, v = {7, 7, 7};
      from[axis] = upward ? Real(0.25) : Real(0.75);
      x[axis] = upward ? Real(18) : Real(-17);
      v[axis] = upward ? Real(1000) : Real(-1000);
      Vector expected = x, expected_v = v;
      expected[axis] = upward ? low[axis] - this->edge_ : high[axis] + this->edge_;
      expected_v[axis] = 0;
      EXPECT_EQ(this->keep(from, &x, &v), SQUALL_CLAMPED);
      EXPECT_EQ(x, expected) << "the motion along the face goes on";
      EXPECT_EQ(v, expected_v);
    }
  }
}

TYPED_TEST(Boundary, AWayPastABoxIsLeftAlone) {
  using Vector = typename TestFixture::Vector;
  this->boxes_ = {this->box({1, 0, 0}, {1.5, 0.5, 1})};
  const std::vector<std::array<Vector, 2>> ways = {
      {Vector{0.5, 0.75, 0.5}, Vector{2, 0.75, 0.5}},        // above it
      {Vector{0.5, 0.25, 0.5}, Vector{0.75, 0.25, 0.5}},     // towards it, ending before
      {Vector{0.75, 0.25, 0.5}, Vector{0.25, 0.25, 0.5}},    // away from it
      {Vector{0.5, 0.5, 0.5}, Vector{1.25, 1.25, 0.5}},      // past its upper edge, diagonally
      {Vector{0.25, 0.25, 0.25}, Vector{0.25, 0.25, 0.25}},  // at rest
  };
  for (const auto& [from, to] : ways) {
    Vector x = to, v = {1, 1, 1};
    EXPECT_EQ(this->keep(from, &x, &v), 0) << from[0] << ' ' << from[1];
    EXPECT_EQ(x, to);
    EXPECT_EQ(v, (Vector{1, 1, 1}));
  }
}

// Resting on a face (margin outside it) and sliding along: stays there, keeps sliding, is not counted.
TYPED_TEST(Boundary, SlidingAlongAFaceIsFree) {
  using Vector = typename TestFixture::Vector;
  this->boxes_ = {this->box({1, 0, 0}, {3, 0.5, 1})};
  const Vector from = {1.5, TypeParam(0.5) + this->edge_, 0.5};
  Vector x = {2.5, from[1], 0.25}, v = {8, 0, -2};
  const Vector to = x;
  EXPECT_EQ(this->keep(from, &x, &v), 0);
  EXPECT_EQ(x, to);
  // pressed onto the face at the same time: only the normal motion ends
  x = {2.5, TypeParam(0.25), 0.25}, v = {8, -4, -2};
  EXPECT_EQ(this->keep(from, &x, &v), SQUALL_CLAMPED);
  EXPECT_EQ(x, to);
  EXPECT_EQ(v, (Vector{8, 0, -2}));
}

TYPED_TEST(Boundary, WhatStartsInsideABoxLeavesThroughTheNearestFace) {
  using Real = TypeParam;
  using Vector = typename TestFixture::Vector;
  this->boxes_ = {this->box({1, 0.5, 0.25}, {3, 1.5, 0.75})};
  const std::vector<std::pair<Vector, std::pair<std::size_t, Real>>> cases = {
      {{1.0625, 1, 0.5}, {0, 1 - this->edge_}},         {{2.9375, 1, 0.5}, {0, 3 + this->edge_}},
      {{2, 0.5625, 0.5}, {1, Real(0.5) - this->edge_}}, {{2, 1.4375, 0.5}, {1, Real(1.5) + this->edge_}},
      {{2, 1, 0.3125}, {2, Real(0.25) - this->edge_}},  {{2, 1, 0.6875}, {2, Real(0.75) + this->edge_}},
  };
  for (const auto& [start, exit] : cases) {
    const auto [axis, face] = exit;
    SCOPED_TRACE(testing::Message() << start[0] << ' ' << start[1] << ' ' << start[2]);
    Vector x = start, v = {0, 0, 0}, expected = start;
    v[axis] = face < start[axis] ? Real(2) : Real(-2);  // further in
    expected[axis] = face;
    EXPECT_EQ(this->keep(start, &x, &v), SQUALL_CLAMPED);
    EXPECT_EQ(x, expected);
    EXPECT_EQ(v, (Vector{0, 0, 0}));
  }
}

TYPED_TEST(Boundary, OnlyTheBoxesThatStandCount) {
  using Vector = typename TestFixture::Vector;
  this->boxes_ = {this->box({3, 0, 0}, {3.5, 2, 1}), this->box({1, 0, 0}, {1.5, 2, 1})};
  Vector x = {2, 1, 0.5}, v = {1, 0, 0};
  EXPECT_EQ(keep_inside(&this->params_, this->boxes_.data(), 1, Vector{0.5, 1, 0.5}.data(), x.data(), v.data()), 0);
  EXPECT_EQ(x[0], 2);
  EXPECT_EQ(keep_inside(&this->params_, this->boxes_.data(), 2, Vector{0.5, 1, 0.5}.data(), x.data(), v.data()),
            SQUALL_CLAMPED);
  EXPECT_EQ(x[0], 1 - this->edge_);
}

// Whatever the way, the end lies outside the box and inside the container.
TYPED_TEST(Boundary, RandomWaysEndWhereTheyMay) {
  using Real = TypeParam;
  using Vector = typename TestFixture::Vector;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Vector low = {1.75, 0.75, 0.375}, high = {2.25, 1.25, 0.625};
  this->boxes_ = {this->box(low, high)};
  auto outside = [&](const Vector& x, Real slack) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (x[axis] <= low[axis] - slack || x[axis] >= high[axis] + slack) return true;
    return false;
  };
  int clamped = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vector from = {static_cast<Real>(0.01 + 3.98 * unit(random)), static_cast<Real>(0.01 + 1.98 * unit(random)),
                         static_cast<Real>(0.01 + 0.98 * unit(random))};
    if (!outside(from, this->edge_)) continue;
    Vector x = {static_cast<Real>(-1 + 6 * unit(random)), static_cast<Real>(-1 + 4 * unit(random)),
                static_cast<Real>(-1 + 3 * unit(random))};
    Vector v = {1, 1, 1};
    clamped += this->keep(from, &x, &v) == SQUALL_CLAMPED;
    ASSERT_TRUE(outside(x, Real(0))) << i << ": " << x[0] << ' ' << x[1] << ' ' << x[2];
    ASSERT_TRUE(is_inside_container(&this->params_, x.data())) << i;
  }
  EXPECT_GT(clamped, 1000);
}

}  // namespace
}  // namespace squall::test
