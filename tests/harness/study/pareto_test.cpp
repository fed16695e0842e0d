#include "harness/study/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace squall::harness {
namespace {

using testing::ElementsAre;

TEST(Pareto, FrontIsWhatNothingElseBeats) {
  EXPECT_THAT(pareto_front({}), ElementsAre());
  EXPECT_THAT(pareto_front({{3, 3, 0}}), ElementsAre(true));
  EXPECT_THAT(pareto_front({{1, 9, 0}, {2, 5, 0}, {3, 6, 0}, {4, 1, 0}, {5, 1, 0}}),
              ElementsAre(true, true, false, true, false));
  EXPECT_THAT(pareto_front({{2, 5, 0}, {2, 4, 0}, {1, 5, 0}}), ElementsAre(false, true, true));
}

TEST(Pareto, OfEqualChoicesTheFirstStands) {
  EXPECT_THAT(pareto_front({{2, 5, 0}, {2, 5, 0}, {2, 5, 0}}), ElementsAre(true, false, false));
}

TEST(Pareto, CheapestWithinAnError) {
  const std::vector<Choice> choices{{5, 0.01, 0}, {3, 0.02, 0}, {1, 0.5, 0}};
  EXPECT_EQ(cheapest_within(choices, 0.02), 1u);
  EXPECT_EQ(cheapest_within(choices, 0.019), 0u);
  EXPECT_EQ(cheapest_within(choices, 1.0), 2u);
  EXPECT_EQ(cheapest_within(choices, 0.001), std::nullopt);
}

TEST(Pareto, BestWithinABudget) {
  const std::vector<Choice> choices{{5, 0.01, 20}, {3, 0.02, 12}, {1, 0.5, 4}, {2, 0.02, 12}};
  EXPECT_EQ(best_within(choices, 20), 0u);
  EXPECT_EQ(best_within(choices, 19.9), 3u) << "of two that err alike, the cheaper one";
  EXPECT_EQ(best_within(choices, 5), 2u);
  EXPECT_EQ(best_within(choices, 3.9), std::nullopt);
}

}  // namespace
}  // namespace squall::harness
