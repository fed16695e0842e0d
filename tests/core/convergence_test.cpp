// The sum that ends an iterative solve: exact, whatever the order; and how far iterations extrapolate.
#include "core/convergence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace squall::test {
namespace {

template <class Real>
class Convergence : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Convergence, Reals);

TYPED_TEST(Convergence, TermsAreClampedAndRoundedToEven) {
  using Real = TypeParam;
  const Real unit = std::ldexp(Real(1), -32);
  EXPECT_EQ(convergence_term(Real(0)), 0);
  EXPECT_EQ(convergence_term(Real(-3)), 0);
  EXPECT_EQ(convergence_term(unit), 1);
  EXPECT_EQ(convergence_term(unit / 2), 0) << "half to even";
  EXPECT_EQ(convergence_term(3 * unit / 2), 2) << "half to even";
  EXPECT_EQ(convergence_term(Real(1024)), std::int64_t{1} << 42);
  EXPECT_EQ(convergence_term(Real(1e30)), std::int64_t{1} << 42);
  EXPECT_EQ(convergence_term(std::numeric_limits<Real>::infinity()), std::int64_t{1} << 42);
  EXPECT_EQ(convergence_term(std::numeric_limits<Real>::quiet_NaN()), 0);
}

TYPED_TEST(Convergence, SumsDoNotDependOnTheOrder) {
  using Real = TypeParam;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-40, 10);
  std::vector<Real> errors;
  for (int i = 0; i < 1025; ++i) errors.push_back(static_cast<Real>(std::exp2(exponent(random))));
  const auto sum = [&] {
    std::int64_t total = 0;
    for (const Real error : errors) total += convergence_term(error);
    return total;
  };
  const std::int64_t expected = sum();
  Real plain = 0;
  for (const Real error : errors) plain += error;
  bool plain_differs = false;
  for (int shuffle = 0; shuffle < 20; ++shuffle) {
    std::shuffle(errors.begin(), errors.end(), random);
    EXPECT_EQ(sum(), expected);
    Real other = 0;
    for (const Real error : errors) other += error;
    plain_differs |= other != plain;
  }
  EXPECT_TRUE(plain_differs) << "these numbers could not tell";
}

TEST(ConvergenceLimit, IsTheMeanTimesTheCount) {
  EXPECT_EQ(convergence_limit(0.5, 3), 3 * (std::int64_t{1} << 31));
  EXPECT_EQ(convergence_limit(1e-3, 1000), 1000 * std::int64_t{4294967});  // 2^32/1000 = 4294967.296
  EXPECT_EQ(convergence_limit(1e-3, 0), 0);
  EXPECT_GT(convergence_limit(0.5, (std::int64_t{1} << 20) + 1), 0) << "no overflow";
}

TEST(Momentum, GrowsAndStartsAgainWhenTheErrorGrew) {
  Momentum momentum;
  EXPECT_EQ(momentum.next<double>(), 0);
  momentum.found(100);
  EXPECT_EQ(momentum.next<double>(), 1.0 / 4);
  momentum.found(50);
  EXPECT_EQ(momentum.next<double>(), 2.0 / 5);
  momentum.found(60);  // grew: known to the next iteration
  EXPECT_EQ(momentum.next<double>(), 0);
  momentum.found(60);  // did not grow
  EXPECT_EQ(momentum.next<double>(), 1.0 / 4);
}

}  // namespace
}  // namespace squall::test
