// Lattice sums and wall shifts against values computed elsewhere (docs/physics.md).
#include <gtest/gtest.h>

#include <vector>

#include "core/frame_plan.h"
#include "support/numbers.h"

namespace squall::test {
namespace {

// Two of the ratios are printed to three decimals and are exact; the sums to five.
TEST(Lattice, SumsMatchTheTable) {
  struct Row {
    double ratio, poly6, spiky, cubic, bell;
  };
  const std::vector<Row> table = {
      {1.400, 0.97347, 1.98354, 1.18775, 1.17743}, {1.683, 0.96272, 1.45220, 1.01483, 1.01289},
      {1.800, 0.98284, 1.34702, 1.00018, 0.99949}, {2.000, 1.00978, 1.23589, 0.99997, 0.99876},
      {2.200, 1.01401, 1.16676, 1.00431, 1.00187}, {2.600, 0.99334, 1.08078, 0.99726, 0.99768},
      {3.000, 1.00219, 1.04745, 1.00179, 1.00108}, {4.000, 1.00000, 1.01482, 1.00008, 1.00002},
  };
  for (const Row& row : table) {
    SCOPED_TRACE(row.ratio);
    // up to 729 terms, added one after the other
    const double tolerance = printed(5) + rounding<double>(729, 2);
    EXPECT_NEAR(lattice_sum(SQUALL_POLY6, row.ratio), row.poly6, tolerance);
    EXPECT_NEAR(lattice_sum(SQUALL_SPIKY, row.ratio), row.spiky, tolerance);
    EXPECT_NEAR(lattice_sum(SQUALL_CUBIC, row.ratio), row.cubic, tolerance);
    EXPECT_NEAR(lattice_sum(SQUALL_BELL, row.ratio), row.bell, tolerance);
  }
}

TEST(Lattice, WallShiftsMatchTheTable) {
  struct Row {
    double ratio, cubic, poly6, spiky, bell;
  };
  const std::vector<Row> table = {
      {1.683, 0.1351, 0.1013, 0.2184, 0.1334}, {1.8, 0.1138, 0.0833, 0.1944, 0.1131},
      {2.0, 0.0833, 0.0558, 0.1558, 0.0835},   {2.2, 0.0617, 0.0368, 0.1249, 0.0622},
      {2.4, 0.0501, 0.0303, 0.1046, 0.0500},   {2.6, 0.0435, 0.0292, 0.0905, 0.0426},
      {3.0, 0.0309, 0.0204, 0.0664, 0.0297},
  };
  for (const Row& row : table) {
    SCOPED_TRACE(row.ratio);
    EXPECT_NEAR(wall_shift(SQUALL_CUBIC, row.ratio), row.cubic, printed(4));
    EXPECT_NEAR(wall_shift(SQUALL_POLY6, row.ratio), row.poly6, printed(4));
    EXPECT_NEAR(wall_shift(SQUALL_SPIKY, row.ratio), row.spiky, printed(4));
    EXPECT_NEAR(wall_shift(SQUALL_BELL, row.ratio), row.bell, printed(4));
  }
}

}  // namespace
}  // namespace squall::test
