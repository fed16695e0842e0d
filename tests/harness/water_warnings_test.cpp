#include "harness/water_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace squall::harness {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Row row_of(Pressure pressure, double worst, double tolerance) {
  Row row;
  row.plan.settings.pressure = pressure;
  row.steps = 10;
  row.density_error_worst = worst;
  row.density_tolerance = tolerance;
  return row;
}

TEST(WaterWarnings, SayHowDenseTheWaterWas) {
  EXPECT_THAT(water_warnings(row_of(Pressure::dfsph, 0.0101, 0.001)),
              ElementsAre(HasSubstr("was 1.01 % too dense on average, where density_tolerance asks for 0.1 %")));
}

TEST(WaterWarnings, AreNotOfWhatIsAskedForOrHardlySeen) {
  EXPECT_THAT(water_warnings(row_of(Pressure::dfsph, 0.0099, 0.001)), IsEmpty());
  EXPECT_THAT(water_warnings(row_of(Pressure::dfsph, 0.0099, 0.0001)), IsEmpty());
  EXPECT_THAT(water_warnings(row_of(Pressure::dfsph, 0.09, 0.01)), IsEmpty());
}

TEST(WaterWarnings, CountSolvesThatWereCutShort) {
  Row row = row_of(Pressure::dfsph, 0.0, 0.001);
  row.unconverged = 3;
  EXPECT_THAT(water_warnings(row), ElementsAre(HasSubstr("3 of 20 pressure solves")));
  row.density_error_worst = 0.5;
  EXPECT_EQ(water_warnings(row).size(), 2u);
}

TEST(WaterWarnings, AreOfDfsphAlone) {
  EXPECT_THAT(water_warnings(row_of(Pressure::mueller, 9.0, 0.001)), IsEmpty());
  EXPECT_THAT(water_warnings(row_of(Pressure::wcsph, 9.0, 0.001)), IsEmpty());
}

}  // namespace
}  // namespace squall::harness
