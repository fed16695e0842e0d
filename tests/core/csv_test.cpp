#include "core/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/errors.h"

namespace {

using Eigen::Vector3d;
using squall::parse_particle_csv;
using testing::ElementsAre;
using testing::StartsWith;

const std::string k_header = "x,y,z,vx,vy,vz\n";

std::string refusal(const std::string& text) {
  try {
    parse_particle_csv(text, "p.csv");
  } catch (const squall::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParticleCsv, ReadsNumbersExactlyAndCountsIds) {
  const auto particles = parse_particle_csv(k_header + "0.1,-2e-3,3,4,5,6\n7,8,9,1.5,2.5,3.5\n", "p.csv");
  EXPECT_THAT(particles.ids, ElementsAre(0u, 1u));
  EXPECT_THAT(particles.positions, ElementsAre(Vector3d(0.1, -2e-3, 3), Vector3d(7, 8, 9)));
  EXPECT_THAT(particles.velocities, ElementsAre(Vector3d(4, 5, 6), Vector3d(1.5, 2.5, 3.5)));
}

TEST(ParticleCsv, TakesWindowsLinesAndAMissingLastNewline) {
  EXPECT_EQ(parse_particle_csv("x,y,z,vx,vy,vz\r\n1,2,3,4,5,6\r\n", "p.csv").size(), 1u);
  EXPECT_EQ(parse_particle_csv("\xEF\xBB\xBF" + k_header + "1,2,3,4,5,6\n", "p.csv").size(), 1u);
  EXPECT_EQ(parse_particle_csv(k_header + "1,2,3,4,5,6", "p.csv").size(), 1u);
  EXPECT_EQ(parse_particle_csv(k_header, "p.csv").size(), 0u);
}

TEST(ParticleCsv, RefusesEverythingElseWithItsPlace) {
  EXPECT_THAT(refusal(""), StartsWith("p.csv:1:1: the first line must be the header x,y,z,vx,vy,vz"));
  EXPECT_THAT(refusal("x,y,z\n"), StartsWith("p.csv:1:1: the first line must be the header"));
  EXPECT_THAT(refusal(k_header + "1,2,3,4,5\n"), StartsWith("p.csv:2:10: a line has six numbers"));
  EXPECT_THAT(refusal(k_header + "1,2,3,4,5,6,7\n"), StartsWith("p.csv:2:12: a line has six numbers"));
  EXPECT_THAT(refusal(k_header + "1,2,3,4,5,6\n\n"), StartsWith("p.csv:3:1: a line has six numbers"));
  EXPECT_THAT(refusal(k_header + "1,,3,4,5,6\n"), StartsWith("p.csv:2:3: '' is not a finite number"));
  EXPECT_THAT(refusal(k_header + "1,2,3,4,5,6x\n"), StartsWith("p.csv:2:11: '6x' is not a finite number"));
  EXPECT_THAT(refusal(k_header + "1, 2,3,4,5,6\n"), StartsWith("p.csv:2:3: ' 2' is not a finite number"));
  EXPECT_THAT(refusal(k_header + "nan,2,3,4,5,6\n"), StartsWith("p.csv:2:1: 'nan' is not a finite number"));
  EXPECT_THAT(refusal(k_header + "1,2,3,4,5,inf\n"), StartsWith("p.csv:2:11: 'inf' is not a finite number"));
  EXPECT_THAT(refusal(k_header + "1,2,3,4,5,1e999\n"), StartsWith("p.csv:2:11: '1e999' is not a finite number"));
}

}  // namespace
