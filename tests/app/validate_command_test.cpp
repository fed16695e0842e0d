#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace squall::app {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// A folder with a falling block of 27 particles, a pressure gauge on the floor, and files a test adds.
class ValidateCommand : public testing::Test {
 protected:
  ValidateCommand() {
    write("fall.toml",
          "schema = 1\n[time]\nduration_s = 0.1\n[fluid]\nspacing_m = 0.1\n[container]\nmin_m = [0, 0, 0]\n"
          "max_m = [1, 1, 1]\n[[block]]\nmin_m = [0.3, 0.6, 0.3]\nmax_m = [0.6, 0.9, 0.6]\n"
          "[[gauge]]\nname = 'floor'\nposition_m = [0.5, 0, 0.5]\nkind = 'pressure'\n");
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string path(const std::string& name) const { return folder_ / name; }

  /// A case about that scene whose one check, of y_cm_m, is written out.
  void write_case(const std::string& check) const {
    write("case.toml",
          "schema = 1\ntitle = 'fall'\nsource = 'Newton'\nscene = 'fall.toml'\nsolvers = ['wcsph', 'dfsph']\n"
          "[[check]]\nquantity = 'y_cm_m'\ntolerance_why = 'a test'\n" +
              check);
  }
  Outcome validate(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "validate");
    return squall(arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(ValidateCommand, PassesWhatFallsAsNewtonSays) {
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n");
  const Outcome outcome = validate({path("case.toml"), "--json", path("r.json"), "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("2 passed, 0 failed as expected, 0 unexpected"));
  EXPECT_THAT(outcome.out, HasSubstr("Newton"));
  const Json json = Json::parse(text_of(path("r.json")));
  EXPECT_TRUE(json["as_expected"]);
  const Json& check = json["cases"][0]["checks"][0];
  EXPECT_EQ(check["unit"], "m");
  ASSERT_EQ(check["results"].size(), 2u);
  const Json& first = check["results"][0];
  EXPECT_EQ(first["verdict"], "pass");
  EXPECT_LT(first["error"], first["tolerance"]);
  EXPECT_EQ(first["points"].size(), 49u);  // 0.1 s at 60 Hz and eight samples a frame, and the start
}

TEST_F(ValidateCommand, ExitsWith5OnAFailure) {
  write_case("value = 0.75\ntolerance = 1e-5\n");
  const Outcome outcome = validate({path("case.toml"), "--pressure", "wcsph"});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.out, HasSubstr("FAILS"));
  EXPECT_THAT(outcome.out, HasSubstr("1 unexpected"));
}

TEST_F(ValidateCommand, ExitsWith0OnAnExpectedFailureAndPrintsItsReason) {
  write_case("value = 0.75\ntolerance = 1e-5\n[[check.fails]]\nsolver = 'wcsph'\nreason = 'it falls'\n");
  const Outcome outcome = validate({path("case.toml"), "--pressure", "wcsph"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("fails, as expected: it falls"));
}

TEST_F(ValidateCommand, ExitsWith5OnAnExpectedFailureThatPasses) {
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n[[check.fails]]\nsolver = 'wcsph'\nreason = 'it should not'\n");
  const Outcome outcome = validate({path("case.toml"), "--pressure", "wcsph"});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.out, HasSubstr("PASSES, unexpected"));
}

TEST_F(ValidateCommand, TakesASceneAndATable) {
  write("table.csv", "time_s,y_cm_m,x_cm_m\n0,0.75,0.45\n0.2,0.5538,0.45\n");  // longer than the scene says
  const std::vector<std::string> given{path("fall.toml"), "--expected", path("table.csv"), "--pressure", "wcsph"};
  auto arguments = given;
  arguments.insert(arguments.end(), {"--tolerance", "1e-5"});
  const Outcome outcome = validate(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("2 passed"));
  const Outcome without = validate(given);
  EXPECT_EQ(without.code, 2);
  EXPECT_THAT(without.err, HasSubstr("--expected and --tolerance belong together"));
}

TEST_F(ValidateCommand, RefusesTablesOutOfOrder) {
  const auto refused = [&](const std::string& table, const std::string& why) {
    write("table.csv", table);
    const Outcome outcome = validate({path("fall.toml"), "--expected", path("table.csv"), "--tolerance", "1"});
    EXPECT_EQ(outcome.code, 3) << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refused("time_s,y_cm_m\n0.2,0.5\n0,0.75\n", "table.csv:3: time 0 comes after 0.2; sort the table");
  refused("time_s,y_cm_m\n0,0.75\n0,0.75\n", "table.csv:3: time 0 is there twice");
  refused("time_s,y_cm_m\n0,0\n0.1,0\n", "column 'y_cm_m' is 0 throughout");
  refused("time_s,y_cm_m\n1e9,1\n", "asks for 1e+09 s of water");
  refused("time_s,y_cm_m\n-1,0.75\n", "time_s = -1 is before the start of the run");
  for (const char* tolerance : {"-1", "nan", "inf"}) {
    write("table.csv", "time_s,y_cm_m\n0,0.75\n");
    EXPECT_EQ(validate({path("fall.toml"), "--expected", path("table.csv"), "--tolerance", tolerance}).code, 2);
  }
}

// Nothing passes where nothing was measured, and no case may expect that.
TEST_F(ValidateCommand, WithoutWaterNothingPasses) {
  std::string scene = text_of(path("fall.toml"));
  const std::size_t block = scene.find("[[block]]");
  write("fall.toml", scene.erase(block, scene.find("[[gauge]]") - block));
  std::string checks;
  for (const char* quantity : {"x_cm_m", "kinetic_j", "mass_kg", "floor", "density_error_max"})
    checks +=
        std::string("[[check]]\nquantity = '") + quantity +
        "'\nvalue = 0\ntolerance = 1\ntolerance_why = 'a test'\n[[check.fails]]\nsolver = 'dfsph'\nreason = 'r'\n";
  write("case.toml",
        "schema = 1\ntitle = 't'\nsource = 's'\nscene = 'fall.toml'\nsolvers = ['wcsph', 'dfsph']\n" + checks);
  const Outcome outcome = validate({path("case.toml"), "--json", path("r.json")});
  EXPECT_EQ(outcome.code, 5) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("no value"));
  EXPECT_THAT(outcome.out, HasSubstr("no particles from 0 to 0.1 s: nothing was measured"));
  EXPECT_THAT(outcome.out, HasSubstr("0 passed, 0 failed as expected, 10 unexpected"));
  const Json json = Json::parse(text_of(path("r.json")));
  for (const auto& check : json["cases"][0]["checks"])
    for (const auto& result : check["results"]) {
      EXPECT_EQ(result["verdict"], "fail");
      EXPECT_EQ(result["as_expected"], false);
      EXPECT_TRUE(result["error"].is_null());
      EXPECT_THAT(result["problem"], HasSubstr("no particles"));
    }
}

TEST_F(ValidateCommand, SaysWhenThereIsNoValue) {
  write("case.toml",
        "schema = 1\ntitle = 't'\nsource = 's'\nscene = 'fall.toml'\nsolvers = ['wcsph']\n"
        "[[check]]\nquantity = 'front_m'\nvalue = 0\ntolerance = 9\ntolerance_why = 'a test'\n"
        "[[check]]\nquantity = 'floor'\nvalue = 0\ntolerance = 9\ntolerance_why = 'a test'\n");
  const Outcome outcome = validate({path("case.toml"), "--json", path("r.json"), "--out", path("out")});
  EXPECT_EQ(outcome.code, 5) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("no value"));
  EXPECT_THAT(outcome.out, HasSubstr("front_m has no value at 49 of 49 times, first at 0 s; it needs a free particle"));
  EXPECT_THAT(outcome.out, HasSubstr("gauge floor was outside of the water from 0.009375 to 0.09271 s"));
  const Json checks = Json::parse(text_of(path("r.json")))["cases"][0]["checks"];
  EXPECT_TRUE(checks[0]["results"][0]["furthest"]["measured"].is_null());
  EXPECT_TRUE(checks[0]["results"][0]["points"][0]["measured"].is_null());
  EXPECT_THAT(text_of(path("out/report.html")), HasSubstr("no value"));
}

TEST_F(ValidateCommand, WritesPlotsSeriesAndAPage) {
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n");
  const Outcome outcome = validate({path("case.toml"), "--pressure", "wcsph", "--out", path("out"), "--quiet"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(text_of(path("out/case_wcsph_omp.csv")), HasSubstr("time_s,front_m"));
  EXPECT_THAT(text_of(path("out/case_wcsph_omp.csv")), HasSubstr(",floor\n"));
  EXPECT_THAT(text_of(path("out/case_y_cm_m.svg")), HasSubstr("<svg"));
  EXPECT_THAT(text_of(path("out/report.html")), HasSubstr("Newton"));
  EXPECT_TRUE(Json::parse(text_of(path("out/validate.json"))).contains("cases"));
}

TEST_F(ValidateCommand, LeavesTheFolderOfOtherCasesAlone) {
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n");
  write("second.toml", text_of(path("case.toml")));
  const auto run = [&](std::vector<std::string> cases) {
    cases.insert(cases.end(), {"--pressure", "wcsph", "--out", path("out"), "--quiet"});
    return validate(cases);
  };
  ASSERT_EQ(run({path("case.toml")}).code, 0);
  const std::string before = text_of(path("out/validate.json")), page = text_of(path("out/report.html"));
  const Outcome other = run({path("second.toml")});
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("holds what `squall validate` found of case case (scene fall, hash "));
  EXPECT_EQ(text_of(path("out/validate.json")), before);
  EXPECT_EQ(text_of(path("out/report.html")), page);
  EXPECT_FALSE(std::filesystem::exists(path("out/second_wcsph_omp.csv")));
  EXPECT_EQ(run({path("case.toml"), path("second.toml")}).code, 0) << "nothing is lost";
  EXPECT_EQ(run({path("case.toml")}).code, 3) << "second would be";
}

// One name is not one scene.
TEST_F(ValidateCommand, LeavesTheFolderOfAnotherSceneOfTheSameNameAlone) {
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n");
  const auto run = [&] {
    return validate({path("case.toml"), "--pressure", "wcsph", "--out", path("out"), "--quiet"});
  };
  ASSERT_EQ(run().code, 0);
  EXPECT_EQ(run().code, 0) << "one's own is replaced";
  const std::string before = text_of(path("out/case_wcsph_omp.csv"));
  std::string scene = text_of(path("fall.toml"));
  scene.replace(scene.find("min_m = [0.3, 0.6"), 0, "velocity_m_s = [0, 1, 0]\n");
  write("fall.toml", scene);
  EXPECT_EQ(run().code, 3);
  EXPECT_EQ(text_of(path("out/case_wcsph_omp.csv")), before);
}

// A run that ends early has failed, whatever is measured; a case may expect that.
TEST_F(ValidateCommand, ARunThatEndsEarlyMayBeAKnownFailure) {
  write(
      "fall.toml",
      "schema = 1\n[time]\nduration_s = 0.1\n[fluid]\nspacing_m = 0.1\n[solver]\nstiffness_m2_s2 = 1e7\ndt_max_s = 1\n"
      "cfl = 10\n[container]\nmin_m = [0, 0, 0]\nmax_m = [1, 1, 1]\nopen_top = true\n[[block]]\nmin_m = [0, 0, 0]\n"
      "max_m = [1, 1, 1]\n");
  for (const char* expected : {"value = 0.5\n", "points = [[0.01, 0.5], [0.1, 0.5]]\n"}) {
    write("case.toml",
          std::string(
              "schema = 1\ntitle = 'blast'\nsource = 'a test'\nscene = 'fall.toml'\nsolvers = ['mueller']\n[[check]]\n"
              "quantity = 'y_cm_m'\ntolerance_why = 'a test'\ntolerance = 1e-5\n") +
              expected + "[[check.fails]]\nsolver = 'mueller'\nreason = 'it flies apart'\n");
    const Outcome outcome = validate({path("case.toml")});
    EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("fails, as expected: it flies apart (")) << expected;
    EXPECT_THAT(outcome.out, HasSubstr("particles are lost")) << expected;
  }
}

TEST_F(ValidateCommand, SaysWhichSolvesEndedAtTheirLimit) {
  std::string scene = text_of(path("fall.toml"));
  scene.replace(scene.find("min_m = [0.3, 0.6"), 0, "velocity_m_s = [0, -9, 0]\n");  // onto the floor
  write("fall.toml", scene + "[solver]\nmax_iterations = 1\n");
  write_case("value = 0.5\ntolerance = 10\n");
  const Outcome outcome = validate({path("case.toml"), "--json", path("r.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("pressure solves ended at max_iterations above their tolerance"));
  const Json runs = Json::parse(text_of(path("r.json")))["cases"][0]["runs"];
  ASSERT_EQ(runs.size(), 2u);
  for (const Json& run : runs) {
    EXPECT_EQ(run.contains("unconverged"), run["pressure"] == "dfsph");
    if (run["pressure"] == "dfsph") {
      EXPECT_GT(run["unconverged"], 0);
    }
  }
}

TEST_F(ValidateCommand, ListsAndRunsWhatComesWithSquall) {
  const Outcome list = validate({"--list"});
  EXPECT_EQ(list.code, 0);
  for (const char* name : {"dam_break", "free_fall", "hydrostatic", "sloshing", "x_cm_m", "ellipsoid"})
    EXPECT_THAT(list.out, HasSubstr(name));
  EXPECT_EQ(validate({"free_fall", "--quiet"}).code, 0);
}

TEST_F(ValidateCommand, SaysWhatItCannotDo) {
  const Outcome name = validate({"dam_brek"});
  EXPECT_EQ(name.code, 3);
  EXPECT_THAT(name.err, HasSubstr("did you mean 'dam_break'?"));
  EXPECT_EQ(validate({path("none.toml")}).code, 3);
  const Outcome scene = validate({path("fall.toml")});
  EXPECT_EQ(scene.code, 3);
  EXPECT_THAT(scene.err, HasSubstr("this is a scene, not a case"));
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n");
  EXPECT_EQ(validate({path("case.toml"), "--pressure", "mueller"}).code, 2);  // takes no part
  EXPECT_EQ(validate({path("case.toml"), "--tolerance", "0.1"}).code, 2);
  EXPECT_EQ(validate({path("case.toml"), "--frames", "3"}).code, 2);
  EXPECT_EQ(validate({path("case.toml"), "--fast-math"}).code, 2);
}

TEST_F(ValidateCommand, DestroysNothingThatItReads) {
  write("table.csv", "time_s,y_cm_m\n0,0.75\n");
  write_case("table = 'table.csv'\ntolerance = 1e-5\n");
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    arguments.push_back("--quiet");
    const Outcome outcome = validate(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  for (const char* file : {"case.toml", "fall.toml", "table.csv"})
    refused({path("case.toml"), "--json", path(file)}, "--json would overwrite");
  const std::vector<std::string> expected{path("fall.toml"), "--expected", path("table.csv"), "--tolerance", "1"};
  for (const char* file : {"fall.toml", "table.csv"}) {
    auto arguments = expected;
    arguments.insert(arguments.end(), {"--json", path(file)});
    refused(arguments, "--json would overwrite");
  }
  std::filesystem::copy(path("table.csv"), path("fall_wcsph_omp.csv"));
  refused({path("fall.toml"), "--expected", path("fall_wcsph_omp.csv"), "--tolerance", "1", "--out", path("")},
          "--out would overwrite");
  refused({path("case.toml"), "--out", path("out"), "--json", path("out/report.html")}, "name the same file");
  EXPECT_EQ(text_of(path("table.csv")), "time_s,y_cm_m\n0,0.75\n");
  EXPECT_EQ(text_of(path("fall_wcsph_omp.csv")), text_of(path("table.csv")));
}

TEST_F(ValidateCommand, TellsCasesApartByTheirNames) {
  write_case("formula = 'ballistic'\ntolerance = 1e-5\n");
  std::filesystem::create_directory(path("other"));
  for (const char* file : {"case.toml", "fall.toml"})
    std::filesystem::copy(path(file), path("other/" + std::string(file)));
  const Outcome outcome = validate({path("case.toml"), path("other/case.toml")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("two cases are called case"));
}

TEST_F(ValidateCommand, SaysHowToReachTimesOutsideOfTheRun) {
  const std::string points = "tolerance = 1\npoints = [[";
  write_case(points + "-1, 0.75]]\n");
  EXPECT_THAT(validate({path("case.toml"), "--pressure", "wcsph"}).out, HasSubstr("set from_s"));
  write_case(points + "9, 0.75]]\n");
  EXPECT_THAT(validate({path("case.toml"), "--pressure", "wcsph"}).out, HasSubstr("lengthen duration_s"));
}

// Above 2.2 dfsph is no choice: not by default, and not by name.
TEST_F(ValidateCommand, LeavesDfsphOutWhereItCannotRun) {
  std::string scene = text_of(path("fall.toml"));
  write("fall.toml", scene.replace(scene.find("spacing_m"), 0, "support_ratio = 2.5\n"));
  write("table.csv", "time_s,y_cm_m\n0,0.75\n");
  const Outcome table = validate({path("fall.toml"), "--expected", path("table.csv"), "--tolerance", "1"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, testing::Not(HasSubstr("dfsph")));
  EXPECT_THAT(table.err, HasSubstr("particles come to lie in pairs"));
  write_case("value = 0\ntolerance = 1\n");
  const Outcome named = validate({path("case.toml")});
  EXPECT_EQ(named.code, 3);
  EXPECT_THAT(named.err, HasSubstr("case.toml:5:21: support_ratio = 2.5 is too large for dfsph"));
}

TEST_F(ValidateCommand, RunWritesGauges) {
  const Outcome outcome = squall({"run", path("fall.toml"), "--frames", "3", "--out", path("out"), "--quiet"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = text_of(path("out/gauges.csv"));
  EXPECT_THAT(text, testing::StartsWith("time_s,floor\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
}

}  // namespace
}  // namespace squall::app
