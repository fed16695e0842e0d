#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace squall::app {
namespace {

using nlohmann::json;

TEST(StressCommand, PrintsATableAndNoSurprise) {
  const Outcome outcome = squall({"stress", "--quick", "--case", "4,20,33", "--pressure", "wcsph"});
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  for (const char* text : {"1: omp, ", "2: opencl 0", " 4 one particle alone", "known: ", "0 unexpected"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text << "\n" << outcome.out;
}

TEST(StressCommand, JsonHoldsFindings) {
  const Outcome outcome = squall({"stress", "--quick", "--case", "4,30", "--backend", "omp", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["quick"], true);
  ASSERT_EQ(result["cases"].size(), 6u);
  for (const auto& tried : result["cases"]) {
    EXPECT_EQ(tried["backend"], "omp");
    if (tried["number"] == 4) {
      EXPECT_EQ(tried["verdict"], "passed");
      EXPECT_GE(tried["findings"].size(), 3u);
    }
    if (tried["number"] == 30 && tried["pressure"] != "dfsph") {
      EXPECT_EQ(tried["verdict"], "not_applicable");
    }
  }
}

TEST(StressCommand, RefusesWhatItCannotTry) {
  EXPECT_EQ(squall({"stress", "--case", "35"}).code, 2);
  EXPECT_EQ(squall({"stress", "--case", "x"}).code, 2);
  EXPECT_EQ(squall({"stress", "--pressure", "none"}).code, 2);
  EXPECT_EQ(squall({"stress", "scene.toml"}).code, 2);
  EXPECT_EQ(squall({"stress", "--case", "4", "--json", "/nowhere/x.json"}).code, 3);
}

}  // namespace
}  // namespace squall::app
