#include "harness/statistics.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/errors.h"

namespace squall::harness {
namespace {

std::vector<double> one_to(int n) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.rbegin(), values.rend(), 1.0);
  return values;
}

TEST(Statistics, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_EQ(median({9.0, 1.0}), 5.0);
  EXPECT_EQ(median({3.0, 100.0, 1.0}), 3.0);
  EXPECT_THROW(median({}), InputError);
}

TEST(Statistics, QuantileIsTheNearestRank) {
  EXPECT_EQ(quantile(one_to(60), 0.95), 57.0);
  EXPECT_EQ(quantile(one_to(60), 0.99), 60.0);
  EXPECT_EQ(quantile(one_to(1000), 0.99), 990.0);
  EXPECT_EQ(quantile({4.0}, 0.01), 4.0);
  EXPECT_THROW(quantile({1.0}, 0.0), InputError);
  EXPECT_THROW(quantile({1.0}, 1.5), InputError);
}

TEST(Statistics, TailNamesTheWorst) {
  const Tail tail = tail_of(one_to(100));
  EXPECT_EQ(tail.median, 50.5);
  EXPECT_EQ(tail.p95, 95.0);
  EXPECT_EQ(tail.p99, 99.0);
  EXPECT_EQ(tail.max, 100.0);
  EXPECT_EQ(tail_of({}).max, 0.0);
}

// Ranks from published tables of the sign test at 95 %.
TEST(Statistics, MedianIntervalHasTheTabulatedRanks) {
  EXPECT_FALSE(median_interval(one_to(5)));
  const auto six = median_interval(one_to(6));
  ASSERT_TRUE(six);
  EXPECT_EQ(six->low, 1.0);
  EXPECT_EQ(six->high, 6.0);
  EXPECT_DOUBLE_EQ(six->confidence, 1.0 - 2.0 / 64.0);
  const auto twenty = median_interval(one_to(20));
  ASSERT_TRUE(twenty);
  EXPECT_EQ(twenty->low, 6.0);
  EXPECT_EQ(twenty->high, 15.0);
  const auto sixty = median_interval(one_to(60));
  ASSERT_TRUE(sixty);
  EXPECT_EQ(sixty->low, 22.0);
  EXPECT_EQ(sixty->high, 39.0);
  EXPECT_GE(sixty->confidence, 0.95);
}

}  // namespace
}  // namespace squall::harness
