// Shares of the rows: all rows, each once, balanced by blocks of particles.

#include "backend_omp/row_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace squall::test {
namespace {

using openmp::Range;

class RowSplit : public testing::TestWithParam<int> {
 protected:
  static constexpr int k_lanes = 8;

  explicit RowSplit(double mean_per_cell = 2.5) {
    p_.cells_x = 5;
    p_.cells_y = 7;
    p_.cells_z = 9;
    std::mt19937 random(1);
    std::poisson_distribution<int> particles(mean_per_cell);
    for (int cell = 0; cell < p_.cells_x * p_.cells_y * p_.cells_z; ++cell)
      start_.push_back(start_.back() + (cell % 11 == 0 ? 4 : 1) * particles(random));
  }
  int start_of_row(int row) const { return start_[static_cast<std::size_t>(row * p_.cells_x)]; }

  int blocks(Range rows) const {
    int sum = 0;
    for (int row = rows.begin; row < rows.end; ++row)
      sum += (start_of_row(row + 1) - start_of_row(row) + k_lanes - 1) / k_lanes;
    return sum;
  }

  Params<float> p_{};
  std::vector<int> start_{0};
};

INSTANTIATE_TEST_SUITE_P(Parts, RowSplit, testing::Values(1, 2, 3, 7, 63, 64, 65, 200));

TEST_P(RowSplit, GivesEveryRowToOneThread) {
  int next = 0;
  for (int part = 0; part < GetParam(); ++part) {
    const Range rows = openmp::split_rows(start_.data(), p_, k_lanes, part, GetParam());
    EXPECT_EQ(rows.begin, next) << "part " << part;
    EXPECT_LE(rows.begin, rows.end);
    next = rows.end;
  }
  EXPECT_EQ(next, p_.cells_y * p_.cells_z);
}

// A share ends with the first row that fills it, so it is too large by less than a row.
TEST_P(RowSplit, GivesEachThreadItsShareOfTheBlocks) {
  const int rows = p_.cells_y * p_.cells_z;
  int largest_row = 0;
  for (int row = 0; row < rows; ++row) largest_row = std::max(largest_row, blocks({row, row + 1}));
  const int all = blocks({0, rows});
  for (int part = 0; part < GetParam(); ++part)
    EXPECT_LE(blocks(openmp::split_rows(start_.data(), p_, k_lanes, part, GetParam())),
              all / GetParam() + 1 + largest_row);
}

TEST_P(RowSplit, OfNoParticlesIsStillAllRows) {
  std::fill(start_.begin(), start_.end(), 0);
  int rows = 0;
  for (int part = 0; part < GetParam(); ++part) {
    const Range share = openmp::split_rows(start_.data(), p_, k_lanes, part, GetParam());
    rows += share.end - share.begin;
  }
  EXPECT_EQ(rows, p_.cells_y * p_.cells_z);
}

}  // namespace
}  // namespace squall::test
