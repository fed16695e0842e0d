#include "harness/validation/case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"

namespace squall::harness {
namespace {

using testing::HasSubstr;

const std::string k_scene =
    "schema = 1\n[time]\nduration_s = 2.0\n[fluid]\nspacing_m = 0.1\n[container]\nmin_m = [0, 0, 0]\n"
    "max_m = [1, 1, 1]\n[[block]]\nmin_m = [0, 0, 0]\nmax_m = [1, 0.5, 1]\n"
    "[[gauge]]\nname = 'p1'\nposition_m = [0, 0.2, 0.5]\nkind = 'pressure'\n";

const std::string k_head = "schema = 1\ntitle = 'tank'\nsource = 'Newton'\nscene = 's.toml'\n";
const std::string k_check = "[[check]]\nquantity = 'p1'\nvalue = 3\ntolerance = 0.1\ntolerance_why = 'because'\n";

Case read(const std::string& text) {
  return parse_case(text, "cases/tank.toml", [](const std::string& path) -> std::string {
    if (path == "cases/s.toml") return k_scene;
    if (path == "cases/t.csv") return "# measured by hand\ntime_s,p1,p1_low,p1_high\n0.5,2,1,3\n1.5,4,,\n";
    throw InputError(path + ": not there");
  });
}

std::string message_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CaseReader, ReadsWhatIsWrittenAndFillsInTheRest) {
  const Case tank = read(k_head + k_check);
  EXPECT_EQ(tank.name, "tank");
  EXPECT_EQ(tank.duration_s, 2.0);
  EXPECT_EQ(tank.samples_per_frame, 8);  // there is a pressure gauge
  EXPECT_EQ(tank.solvers.size(), 3u);
  ASSERT_EQ(tank.checks.size(), 1u);
  EXPECT_EQ(tank.checks[0].name, "p1");
  EXPECT_EQ(tank.checks[0].source, "Newton");
  EXPECT_EQ(tank.checks[0].expected.value, 3.0);
}

TEST(CaseReader, ConvertsTablesToSi) {
  const Case tank = read(k_head +
                         "[[check]]\nquantity = 'p1'\ntable = 't.csv'\ntime_scale_s = 0.5\ntime_offset_s = 0.1\n"
                         "value_scale = 100\nvalue_offset = 7\ntolerance = 1\ntolerance_why = 'x'\n");
  const auto& points = tank.checks[0].expected.points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_DOUBLE_EQ(points[0].time_s, 0.35);
  EXPECT_DOUBLE_EQ(points[0].value, 207.0);
  EXPECT_DOUBLE_EQ(*points[0].low, 107.0);
  EXPECT_DOUBLE_EQ(*points[0].high, 307.0);
  EXPECT_FALSE(points[1].low);
}

TEST(CaseReader, ReadsExpectedFailures) {
  const Case tank = read(k_head + "solvers = ['wcsph', 'mueller']\n" + k_check +
                         "[[check.fails]]\nsolver = 'mueller'\nreason = 'half'\n");
  ASSERT_EQ(tank.checks[0].fails.size(), 1u);
  EXPECT_EQ(tank.checks[0].fails[0].pressure, Pressure::mueller);
}

TEST(CaseReader, SaysWhereAndWhatIsWrong) {
  EXPECT_THAT(message_of(k_scene), HasSubstr("this is a scene, not a case"));
  EXPECT_THAT(message_of(k_head + "sorce = 'x'\n" + k_check), HasSubstr("cases/tank.toml:5:1: unknown key 'sorce'"));
  EXPECT_THAT(message_of(k_head), HasSubstr("at least one [[check]]"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'frnt_m'\nvalue = 1\n"),
              HasSubstr("cases/tank.toml:6:12: quantity 'frnt_m' is unknown; did you mean 'front_m'?"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'p1'\nvalue = 1\nlike = 'p1'\n"), HasSubstr("it has 2"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'p1'\nvalue = 1\n"), HasSubstr("needs tolerance"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'p1'\nvalue = 1\ntolerance = 1\n"),
              HasSubstr("key tolerance_why is missing"));
  EXPECT_THAT(message_of(k_head + k_check + "measure = 'maximum'\n"), HasSubstr("there are max, rms, mean"));
  EXPECT_THAT(message_of(k_head + k_check + "tolerance = -1\n"), HasSubstr("not valid TOML"));
  EXPECT_THAT(message_of(k_head + k_check + "to_s = -1\n"), HasSubstr("to_s = -1 in [[check]] 1 is out of range"));
  EXPECT_THAT(message_of(k_head + k_check + k_check), HasSubstr("two checks are called 'p1'"));
  EXPECT_THAT(message_of(k_head + k_check + "[[check.fails]]\nsolver = 'pbf'\nreason = 'x'\n"), HasSubstr("pbf"));
  EXPECT_THAT(
      message_of(k_head + "solvers = ['wcsph']\n" + k_check + "[[check.fails]]\nsolver = 'mueller'\nreason = 'x'\n"),
      HasSubstr("mueller takes no part"));
  EXPECT_THAT(message_of(k_head + "[run]\nduration_s = 0\n" + k_check), HasSubstr("duration_s = 0 in [run]"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'p1'\ntable = 'u.csv'\n"), HasSubstr("u.csv: not there"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'front_m'\ntable = 't.csv'\n"), HasSubstr("it has p1"));
  EXPECT_THAT(
      message_of(k_head + "[[check]]\nquantity = 'p1'\nformula = 'sloshing'\ntolerance = 1\ntolerance_why = 'x'\n"),
      HasSubstr("does not give p1"));
  EXPECT_THAT(message_of("schema = 1\ntitle = 't'\nsource = 's'\nscene = 'gone.toml'\n" + k_check),
              HasSubstr("cases/tank.toml:4:9: cases/gone.toml: not there"));
}

/// A check of p1 that says what else it is; its tolerance is there.
std::string message_of_check(const std::string& lines) {
  return message_of(k_head + "[[check]]\nquantity = 'p1'\ntolerance = 1\ntolerance_why = 'x'\n" + lines);
}

TEST(CaseReader, RefusesWhatAlwaysPasses) {
  EXPECT_THAT(message_of_check("like = 'p1'\n"), HasSubstr("cases/tank.toml:9:8: p1 is always like itself"));
  EXPECT_EQ(message_of_check("like = 'mass_kg'\nmeasure = 'slope'\n"), "no error");
  EXPECT_THAT(message_of_check("like = 'mass_kg'\n"), HasSubstr("p1 [Pa] and mass_kg [kg] have no difference"));
  EXPECT_THAT(message_of_check("like = ''\n"), HasSubstr("like '' is unknown"));
  EXPECT_THAT(message_of_check("formula = ''\n"), HasSubstr("formula '' is unknown"));
  EXPECT_THAT(message_of_check("value = nan\n"), HasSubstr("value"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'p1'\nvalue = 1\ntolerance = nan\n"), HasSubstr("tolerance"));
  EXPECT_THAT(message_of(k_head + "[[check]]\nquantity = 'p1'\nvalue = 1\ntolerance = -0.1\n"),
              HasSubstr("tolerance = -0.1 in [[check]] 1 is out of range"));
}

TEST(CaseReader, RefusesWhatIsNeverLookedAt) {
  EXPECT_THAT(message_of_check("value = 1\nto_s = 2.5\n"),
              HasSubstr("cases/tank.toml:10:8: to_s = 2.5 is after the end of the run, 2 s"));
  EXPECT_THAT(message_of_check("value = 1\nfrom_s = 3\n"), HasSubstr("from_s = 3 is after the end"));
  EXPECT_EQ(message_of_check("value = 1\nto_s = 2\n"), "no error");
  EXPECT_THAT(message_of_check("points = [[0.5, 1], [1, 2]]\nfrom_s = 1.5\n"), HasSubstr("no expected value lies"));
  EXPECT_THAT(message_of_check("formula = 'ellipsoid'\n"), HasSubstr("without gravity"));
}

TEST(CaseReader, RefusesMeasuresThatSayNothing) {
  EXPECT_THAT(message_of_check("value = 1\nmeasure = 'slope'\n"), HasSubstr("measure slope needs expected values"));
  EXPECT_THAT(message_of_check("points = [[0.5, 1], [1, 1]]\nmeasure = 'line'\n"), HasSubstr("measure line needs"));
  EXPECT_THAT(message_of_check("points = [[0.5, 1], [1, 2]]\nmeasure = 'period'\n"), HasSubstr("held against value"));
  EXPECT_THAT(message_of_check("formula = 'start'\nmeasure = 'period'\n"), HasSubstr("held against value"));
  EXPECT_THAT(message_of_check("value = 0\nrelative = true\n"), HasSubstr("cases/tank.toml:10:12: relative means"));
  EXPECT_THAT(message_of_check("points = [[0.5, 0], [1, 2]]\nrelative = true\n"), HasSubstr("relative means"));
  EXPECT_EQ(message_of_check("points = [[0.5, 0], [1, 2]]\nrelative = true\nfrom_s = 0.6\n"), "no error");
  EXPECT_THAT(message_of_check("points = [[0.5, 1], [1, 2]]\nrelative = true\nmeasure = 'slope'\n"),
              HasSubstr("relative is no part of measure slope"));
}

TEST(CaseReader, RefusesPointsOutOfOrder) {
  EXPECT_THAT(message_of_check("points = [[1, 1],\n  [0.5, 2]]\n"),
              HasSubstr("cases/tank.toml:10:3: time 0.5 comes after 1; sort the table"));
  EXPECT_THAT(message_of_check("points = [[1, 1], [1, 2]]\n"), HasSubstr("time 1 is there twice"));
  EXPECT_THAT(message_of_check("points = [[inf, 1]]\n"), HasSubstr("points must be an array of [time, value]"));
  EXPECT_THAT(message_of_check("points = []\n"), HasSubstr("points must be an array of [time, value]"));
  EXPECT_THAT(message_of_check("points = [[1, 1, 2, 3]]\n"),
              HasSubstr("value 1 must lie between its low (2) and high (3)"));
}

TEST(CaseReader, TurnsLowAndHighWhereTheScaleIsNegative) {
  const Case tank = read(k_head +
                         "[[check]]\nquantity = 'p1'\npoints = [[1, 2, 1, 4]]\nvalue_scale = -1\ntolerance = 1\n"
                         "tolerance_why = 'x'\n");
  const ExpectedPoint& point = tank.checks[0].expected.points.at(0);
  EXPECT_EQ(*point.low, -4.0);
  EXPECT_EQ(*point.high, -1.0);
}

TEST(ExpectedTable, RefusesWhatIsNoTable) {
  const auto message = [](const std::string& text) {
    try {
      parse_expected_csv(text, "t.csv");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message(""), HasSubstr("the table is empty"));
  EXPECT_THAT(message("t,x\n1,2\n"), HasSubstr("t.csv:1: the first line must be a header: time_s"));
  EXPECT_THAT(message("time_s,x\n1\n"), HasSubstr("t.csv:2: this line has 1 cells, the header 2"));
  EXPECT_THAT(message("time_s,x\n1,two\n"), HasSubstr("'two' is not a finite number"));
  EXPECT_THAT(message("time_s,x,x\n"), HasSubstr("column 'x' is there twice"));
  EXPECT_THAT(message("time_s,x\n1,\n"), HasSubstr("column 'x' has no value"));
  EXPECT_THAT(message("time_s,x\n0,1\n0.2,2\n0.1,3\n"), HasSubstr("t.csv:4: time 0.1 comes after 0.2; sort the table"));
  EXPECT_THAT(message("time_s,x\n0,1\n\n0,2\n"), HasSubstr("t.csv:4: time 0 is there twice"));
  EXPECT_THAT(message("time_s,x,y\n0,1,2\n1,,3\n1,2,\n"), HasSubstr("t.csv:4: time 1 is there twice"));
  EXPECT_THAT(message("time_s,x\ninf,1\n"), HasSubstr("t.csv:2: 'inf' is not a finite number"));
  EXPECT_THAT(message("time_s,x\n0,nan\n"), HasSubstr("t.csv:2: 'nan' is not a finite number"));
  EXPECT_THAT(message("time_s,x\n0,1 000\n"), HasSubstr("t.csv:2: '1 000' is not a finite number"));
  EXPECT_THAT(message("time_s,x,x_low\n0,1,2\n"), HasSubstr("t.csv:2: x: value 1 must lie between its low (2)"));
  EXPECT_EQ(message("\xEF\xBB\xBFtime_s, x\r\n# c\r\n1, 2\r\n"), "no error");
}

}  // namespace
}  // namespace squall::harness
