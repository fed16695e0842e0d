#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>

#include "core/errors.h"
#include "core/fill.h"
#include "core/scene.h"

namespace {

using squall::InputError;
using squall::parse_scene;
using squall::Scene;
using testing::HasSubstr;
using testing::StartsWith;

const std::string k_good_scene = R"(schema = 1
[time]
duration_s = 2.0
frame_rate_hz = 60.0
[fluid]
spacing_m = 0.1
[solver]
cfl = 0.4
[gravity]
vector_m_s2 = [0.0, -9.81, 0.0]
[container]
min_m = [0.0, 0.0, 0.0]
max_m = [2.0, 2.0, 1.0]
open_top = true
[[container.motion]]
start_s = 0.5
duration_s = 0.5
displacement_m = [-0.4, 0.0, 0.0]
[[box]]
min_m = [1.5, 0.0, 0.0]
max_m = [1.7, 0.2, 1.0]
[[block]]
min_m = [0.0, 0.0, 0.0]
max_m = [0.5, 1.0, 1.0]
[[rain]]
particles_per_s = 10.0
area_min_m = [0.1, 0.1]
area_max_m = [1.9, 0.9]
height_m = 2.1
max_particles = 50
)";

/// The good scene with one thing changed, and how the message must begin.
struct BadScene {
  const char* name;
  std::string what;  ///< text of the good scene that is replaced; empty: `by` comes after its end
  std::string by;
  std::string message;
};

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

std::string changed(const BadScene& bad) {
  std::string text = k_good_scene;
  if (bad.what.empty()) return text + bad.by;
  const std::size_t at = text.find(bad.what);
  if (at == std::string::npos) throw std::logic_error("the good scene has no '" + bad.what + "'");
  return text.replace(at, bad.what.size(), bad.by);
}

class BadSceneTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneTest, IsRefusedWithItsPlaceAndCause) {
  try {
    parse_scene(changed(GetParam()), "bad.toml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("bad.toml:" + GetParam().message));
  }
}

const BadScene k_unknown[] = {
    {"key_in_table", "spacing_m", "spacng_m", "6:1: unknown key 'spacng_m' in [fluid]; did you mean 'spacing_m'?"},
    {"unit_forgotten", "duration_s = 2.0", "duration = 2.0",
     "3:1: unknown key 'duration' in [time]; did you mean 'duration_s'?"},
    {"key_in_solver", "cfl", "clf", "8:1: unknown key 'clf' in [solver]; did you mean 'cfl'?"},
    {"key_in_gravity", "vector_m_s2", "vector_m_s",
     "10:1: unknown key 'vector_m_s' in [gravity]; did you mean 'vector"},
    {"key_in_container", "open_top", "opentop", "14:1: unknown key 'opentop' in [container]; did you mean 'open_top'?"},
    {"key_in_motion", "displacement_m", "displacment_m", "18:1: unknown key 'displacment_m' in [[container.motion]] 1"},
    {"key_in_box", "[[box]]", "[[box]]\nuntill_s = 1.0",
     "20:1: unknown key 'untill_s' in [[box]] 1; did you mean 'until"},
    {"key_in_block", "[[block]]", "[[block]]\nheld_s = 1.0",
     "23:1: unknown key 'held_s' in [[block]] 1; did you mean 'min_m'?"},
    {"key_in_second_block", "", "[[block]]\nsize_m = 1.0", "32:1: unknown key 'size_m' in [[block]] 2"},
    {"key_in_rain", "particles_per_s", "particle_per_s",
     "26:1: unknown key 'particle_per_s' in [[rain]] 1; did you mean 'par"},
    {"table", "[solver]", "[solvr]", "7:2: unknown key 'solvr' in the scene; did you mean 'solver'?"},
    {"key_at_top", "schema = 1", "schema = 1\nviscosity_m2_s = 1.0", "2:1: unknown key 'viscosity_m2_s' in the scene"},
    {"first_of_two", "spacing_m = 0.1", "zz = 1\naa = 1", "6:1: unknown key 'zz' in [fluid]"},
};

const BadScene k_wrong_type[] = {
    {"text_for_number", "0.1", "\"0.1\"", "6:13: spacing_m in [fluid] must be a number, not a string"},
    {"boolean_for_number", "cfl = 0.4", "cfl = true", "8:7: cfl in [solver] must be a number, not a boolean"},
    {"number_for_boolean", "open_top = true", "open_top = 1",
     "14:12: open_top in [container] must be true or false, not an i"},
    {"number_for_vector", "min_m = [0.0, 0.0, 0.0]", "min_m = 0.0",
     "12:9: min_m in [container] must be an array of 3 numbers"},
    {"short_vector", "max_m = [2.0, 2.0, 1.0]", "max_m = [2.0, 2.0]",
     "13:9: max_m in [container] must have 3 numbers, not 2"},
    {"long_area", "[1.9, 0.9]", "[1.9, 2.0, 0.9]", "28:14: area_max_m in [[rain]] 1 must have 2 numbers, not 3"},
    {"text_in_vector", "[2.0, 2.0, 1.0]", "[2.0, 'b', 1.0]",
     "13:15: max_m in [container] must be a number, not a string"},
    {"fraction_for_count", "max_particles = 50", "max_particles = 50.0",
     "30:17: max_particles in [[rain]] 1 must be an integer"},
    {"table_for_number", "cfl = 0.4", "cfl = {a = 1}", "8:7: cfl in [solver] must be a number, not a table"},
    {"date_for_number", "cfl = 0.4", "cfl = 2016-01-01", "8:7: cfl in [solver] must be a number, not a date or time"},
    {"table_for_list", "[[block]]", "[block]", "22:1: block must be an array of tables, [[block]], not a table"},
    {"list_for_table", "[fluid]", "[[fluid]]", "5:1: fluid must be a table, [fluid], not an array of tables"},
    {"list_of_numbers", "schema = 1", "schema = 1\nparticles = [1]", "2:14: particles must be an array of tables"},
    {"pressure_number", "cfl = 0.4", "pressure = 1", "8:12: pressure in [solver] must be a string, not an integer"},
    {"schema_text", "schema = 1", "schema = '1'", "1:10: schema must be an integer, not a string"},
};

const BadScene k_value[] = {
    {"nan", "0.1", "nan", "6:13: spacing_m = nan in [fluid] must be a finite number"},
    {"infinite", "[2.0, 2.0, 1.0]", "[2.0, inf, 1.0]", "13:15: max_m = inf in [container] must be a finite number"},
    {"negative_infinite", "cfl = 0.4", "cfl = -inf", "8:7: cfl = -inf in [solver] must be a finite number"},
    {"spacing_zero", "0.1", "0", "6:13: spacing_m = 0 in [fluid] is out of range; allowed is 1e-04 to 10"},
    {"spacing_negative", "0.1", "-0.1", "6:13: spacing_m = -0.1 in [fluid] is out of range; allowed is 1e-04 to 10"},
    {"spacing_large", "0.1", "10.1", "6:13: spacing_m = 10.1 in [fluid] is out of range; allowed is 1e-04 to 10"},
    {"spacing_small", "0.1", "9e-5", "6:13: spacing_m = 9e-05 in [fluid] is out of range; allowed is 1e-04 to 10"},
    {"far_away", "[2.0, 2.0, 1.0]", "[100001.0, 2.0, 1.0]",
     "13:9: max_m = 100001 in [container] is out of range; allowed is -1e+05 to 1e+05"},
    {"support", "0.1", "0.1\nsupport_ratio = 1.0",
     "7:17: support_ratio = 1 in [fluid] is out of range; allowed is 1.2 to 4"},
    {"density", "0.1", "0.1\nrest_density_kg_m3 = 0",
     "7:22: rest_density_kg_m3 = 0 in [fluid] is out of range; allowed is 1 to"},
    {"viscosity", "0.1", "0.1\nviscosity_m2_s = -1",
     "7:18: viscosity_m2_s = -1 in [fluid] is out of range; allowed is 0 to 100"},
    {"duration", "duration_s = 2.0", "duration_s = 0.0",
     "3:14: duration_s = 0 in [time] is out of range; allowed is 0.001"},
    {"frame_rate_low", "60.0", "0.1",
     "4:17: frame_rate_hz = 0.1 needs 2000 sub-steps of dt_max_s = 0.005 per frame; allowed are 1000"},
    {"frame_rate", "60.0", "1001", "4:17: frame_rate_hz = 1001 in [time] is out of range; allowed is 0.1 to 1000"},
    {"cfl", "cfl = 0.4", "cfl = 0", "8:7: cfl = 0 in [solver] is out of range; allowed is 0.001 to 100"},
    {"dt_max", "cfl = 0.4", "dt_max_s = 2", "8:12: dt_max_s = 2 in [solver] is out of range; allowed is 1e-07 to 1"},
    {"iterations", "cfl = 0.4", "max_iterations = 0",
     "8:18: max_iterations = 0 in [solver] is out of range; allowed is 1 to 1"},
    {"iterations_huge", "cfl = 0.4", "max_iterations = 5000000000",
     "8:18: max_iterations = 5000000000 in [solver] is out of r"},
    {"sound", "cfl = 0.4", "speed_of_sound_m_s = 0", "8:22: speed_of_sound_m_s = 0 in [solver] is out of range"},
    {"gravity", "-9.81", "-9810.0",
     "10:15: vector_m_s2 = -9810 in [gravity] is out of range; allowed is -1000 to 1000"},
    {"rain_rate", "particles_per_s = 10.0", "particles_per_s = -1",
     "26:19: particles_per_s = -1 in [[rain]] 1 is out of range"},
    {"rain_limit", "max_particles = 50", "max_particles = 268435457",
     "30:17: max_particles = 268435457 in [[rain]] 1 is out of range; allowed is 0 to 268435456"},
    {"drop", "height_m = 2.1", "height_m = 2.1\ndrop_diameter_mm = 9",
     "30:20: drop_diameter_mm = 9 in [[rain]] 1 is out of"},
    {"rain_start", "height_m = 2.1", "height_m = 2.1\nstart_s = -1",
     "30:11: start_s = -1 in [[rain]] 1 is out of range"},
    {"schema_other", "schema = 1", "schema = 2", "1:10: schema = 2 is not known; this version reads schema 1"},
    {"pressure_name", "cfl = 0.4", "pressure = 'sph'",
     "8:12: pressure 'sph' is not known; valid names: mueller, wcsph, dfsph"},
    {"too_many", "spacing_m = 0.1", "spacing_m = 0.001",
     "6:13: the scene has 500000050 particles, rain included; allowed is up to 268435456; raise spacing_m"},
};

const BadScene k_missing[] = {
    {"schema", "schema = 1\n", "", "1:1: schema is missing; write schema = 1 at the top"},
    {"spacing", "spacing_m = 0.1\n", "", "5:1: key spacing_m is missing in [fluid]"},
    {"duration", "duration_s = 2.0\n", "", "2:1: key duration_s is missing in [time]"},
    {"container_max", "max_m = [2.0, 2.0, 1.0]\n", "", "11:1: key max_m is missing in [container]"},
    {"block_min", "[[block]]\nmin_m = [0.0, 0.0, 0.0]\n", "[[block]]\n", "22:1: key min_m is missing in [[block]] 1"},
    {"rain_height", "height_m = 2.1\n", "", "25:1: key height_m is missing in [[rain]] 1"},
    {"table", "[fluid]\nspacing_m = 0.1\n", "", "1:1: table [fluid] is missing"},
    {"file", "", "[[particles]]\n", "31:1: key file is missing in [[particles]] 1"},
};

const BadScene k_geometry[] = {
    {"container_empty", "max_m = [2.0, 2.0, 1.0]", "max_m = [2.0, 0.0, 1.0]",
     "13:9: [container] is empty: its min 0 is not below its max 0 in y"},
    {"container_thin", "max_m = [2.0, 2.0, 1.0]", "max_m = [2.0, 2.0, 0.05]",
     "13:9: [container] is 0.05 m thin in z and has no room for one particle; make it at least spacing_m = 0.1 thick"},
    {"box_empty", "max_m = [1.7, 0.2, 1.0]", "max_m = [1.5, 0.2, 1.0]",
     "21:9: [[box]] 1 is empty: its min 1.5 is not below"},
    {"box_outside", "[1.5, 0.0, 0.0]\nmax_m = [1.7,", "[2.5, 0.0, 0.0]\nmax_m = [2.7,",
     "20:9: box 1 ((2.5, 0, 0) to (2.7, 0.2, 1)) lies outside the container ((0, 0, 0) to (2, 2, 1)) in x"},
    {"block_empty", "max_m = [0.5, 1.0, 1.0]", "max_m = [0.5, 1.0, -1.0]",
     "24:9: [[block]] 1 is empty: its min 0 is not"},
    {"block_thin", "max_m = [0.5, 1.0, 1.0]", "max_m = [0.09, 1.0, 1.0]",
     "24:9: [[block]] 1 is 0.09 m thin in x and has"},
    {"block_outside", "max_m = [0.5, 1.0, 1.0]", "max_m = [0.5, 1.0, 1.1]",
     "24:9: block 1 ((0, 0, 0) to (0.5, 1, 1.1)) reaches outside the container ((0, 0, 0) to (2, 2, 1)) in z"},
    {"block_below", "[[block]]\nmin_m = [0.0, 0.0, 0.0]", "[[block]]\nmin_m = [0.0, -0.1, 0.0]",
     "23:9: block 1 ((0, -0.1, 0)"},
    {"block_lost", "max_m = [0.5, 1.0, 1.0]", "max_m = [0.5, 23.0, 1.0]",
     "24:9: block 1 ((0, 0, 0) to (0.5, 23, 1)) reaches"},
    {"blocks_overlap", "", "[[block]]\nmin_m = [0.4, 0.9, 0.0]\nmax_m = [0.9, 1.9, 0.5]\n",
     "32:9: block 2 overlaps block 1 ((0, 0, 0) to (0.5, 1, 1)); move them apart"},
    {"rain_winds", "",
     "[[rain]]\nparticles_per_s = 1.0\narea_min_m = [0.1, 0.1]\narea_max_m = [1.9, 0.9]\nheight_m = 2.1\n"
     "max_particles = 5\nwind_m_s = [1, 0, 0]\n",
     "37:12: [[rain]] 2 must have the wind_m_s of [[rain]] 1: one wind blows over a scene"},
    {"rain_area_empty", "[1.9, 0.9]", "[1.9, 0.1]",
     "28:14: [[rain]] 1 is empty: its min 0.1 is not below its max 0.1 in z"},
    {"rain_area_outside", "[1.9, 0.9]", "[1.9, 1.1]",
     "28:14: the area of [[rain]] 1 reaches outside the container in z: 0.1 to 1.1; allowed is 0 to 1"},
    {"rain_area_before", "[0.1, 0.1]", "[-0.1, 0.1]",
     "27:14: the area of [[rain]] 1 reaches outside the container in x"},
    {"rain_below_top", "height_m = 2.1", "height_m = 1.9",
     "29:12: height_m = 1.9 in [[rain]] 1 is out of range; allowed is the container's top, 2, to 21.8675"},
    {"rain_too_high", "height_m = 2.1", "height_m = 22.5", "29:12: height_m = 22.5 in [[rain]] 1 is out of range"},
    {"rain_on_lid", "open_top = true", "open_top = false",
     "25:1: [[rain]] 1 cannot fall into a container with a lid; set open_top = true in [container]"},
};

const BadScene k_together[] = {
    {"no_rate", "particles_per_s = 10.0\n", "",
     "25:1: [[rain]] 1 needs exactly one of rate_mm_h and particles_per_s; it has neither"},
    {"both_rates", "height_m = 2.1", "height_m = 2.1\nrate_mm_h = 10",
     "26:19: [[rain]] 1 needs exactly one of rate_mm_h and particles_per_s; it has both"},
    {"no_motion", "displacement_m = [-0.4, 0.0, 0.0]\n", "",
     "15:1: [[container.motion]] 1 needs exactly one of displacement_m and acceleration_m_s2; it has neither"},
    {"both_motions", "start_s = 0.5", "start_s = 0.5\nacceleration_m_s2 = [1, 0, 0]",
     "17:21: [[container.motion]] 1 needs exact"},
    {"hard_motion", "duration_s = 0.5\ndisp", "duration_s = 0.01\ndisp",
     "17:14: [[container.motion]] 1 accelerates the co"},
    {"rain_stops_first", "height_m = 2.1", "height_m = 2.1\nstart_s = 2\nstop_s = 2",
     "31:10: stop_s = 2 in [[rain]] 1 is not after start_s = 2"},
    {"negative_pressure", "cfl = 0.4", "negative_pressure = true",
     "8:21: negative_pressure = true needs pressure = \"mueller\" in [solver]"},
    {"dfsph_sees_too_far", "0.1\n[solver]", "0.1\nsupport_ratio = 2.3\n[solver]\npressure = 'dfsph'",
     "7:17: support_ratio = 2.3 is too large for dfsph"},
    {"xsph", "cfl = 0.4", "pressure = 'wcsph'\nxsph = 0.05", "9:8: xsph = 0.05 needs pressure dfsph, not wcsph"},
};

const BadScene k_not_in_this_version[] = {
    {"surface_tension", "0.1", "0.1\nsurface_tension_n_m = 0.07", "7:23: surface tension is not in this version"},
};

const BadScene k_gauges[] = {
    {"kind", "", "[[gauge]]\nname = 'g'\nposition_m = [1, 1, 0.5]\nkind = 'depth'\n",
     "34:8: kind = 'depth' in [[gauge]] 1 is unknown; there are level, pressure, velocity"},
    {"no_name", "", "[[gauge]]\nposition_m = [1, 1, 0.5]\nkind = 'level'\n", "31:1: key name is missing in [[gauge]]"},
    {"name_with_comma", "", "[[gauge]]\nname = 'a,b'\nposition_m = [1, 1, 0.5]\nkind = 'level'\n",
     "32:8: the name of [[gauge]] 1 holds a comma"},
    {"name_of_time", "", "[[gauge]]\nname = 'time_s'\nposition_m = [1, 1, 0.5]\nkind = 'level'\n",
     "32:8: a gauge cannot be called time_s"},
    {"same_name", "",
     "[[gauge]]\nname = 'g'\nposition_m = [1, 1, 0.5]\nkind = 'level'\n"
     "[[gauge]]\nname = 'g'\nposition_m = [1, 1, 0.5]\nkind = 'pressure'\n",
     "36:8: gauges 1 and 2 are both called 'g'"},
    {"same_column", "",
     "[[gauge]]\nname = 'g_y'\nposition_m = [1, 1, 0.5]\nkind = 'level'\n"
     "[[gauge]]\nname = 'g'\nposition_m = [1, 1, 0.5]\nkind = 'velocity'\n",
     "36:8: gauges 1 ('g_y') and 2 ('g') both have a column 'g_y'"},
    {"outside", "", "[[gauge]]\nname = 'g'\nposition_m = [1, 1, 1.5]\nkind = 'velocity'\n",
     "33:14: gauge 'g' at (1, 1, 1.5) lies outside the container ("},
};

const BadScene k_syntax[] = {
    {"no_value", "cfl = 0.4", "cfl =", "8:6: not valid TOML: "},
    {"open_array", "[2.0, 2.0, 1.0]", "[2.0, 2.0", "14:1: not valid TOML: "},
    {"key_twice", "cfl = 0.4", "cfl = 0.4\ncfl = 0.4", "9:7: not valid TOML: "},
    {"not_text", "schema = 1", "schema = 1\n\x01", "2:1: not valid TOML: "},
    {"open_string", "cfl = 0.4", "pressure = \"wcsph", "8:"},
};

std::string name_of(const testing::TestParamInfo<BadScene>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Unknown, BadSceneTest, testing::ValuesIn(k_unknown), name_of);
INSTANTIATE_TEST_SUITE_P(WrongType, BadSceneTest, testing::ValuesIn(k_wrong_type), name_of);
INSTANTIATE_TEST_SUITE_P(Value, BadSceneTest, testing::ValuesIn(k_value), name_of);
INSTANTIATE_TEST_SUITE_P(Missing, BadSceneTest, testing::ValuesIn(k_missing), name_of);
INSTANTIATE_TEST_SUITE_P(Geometry, BadSceneTest, testing::ValuesIn(k_geometry), name_of);
INSTANTIATE_TEST_SUITE_P(Together, BadSceneTest, testing::ValuesIn(k_together), name_of);
INSTANTIATE_TEST_SUITE_P(NotInThisVersion, BadSceneTest, testing::ValuesIn(k_not_in_this_version), name_of);
INSTANTIATE_TEST_SUITE_P(Gauge, BadSceneTest, testing::ValuesIn(k_gauges), name_of);
INSTANTIATE_TEST_SUITE_P(Syntax, BadSceneTest, testing::ValuesIn(k_syntax), name_of);

TEST(GoodScene, ThatTheBadOnesDifferFromIsAccepted) { EXPECT_NO_THROW(parse_scene(k_good_scene, "good.toml")); }

TEST(BadSceneFile, ThatIsMissingIsRefused) {
  try {
    squall::load_scene("no-such-folder/no-such-scene.toml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("no-such-folder/no-such-scene.toml: cannot be read: "));
  }
}

TEST(BadSceneFile, ThatIsAFolderIsRefused) { EXPECT_THROW(squall::load_scene(SQUALL_SCENES_DIR), InputError); }

TEST(MangledScene, IsReadOrRefusedAndNothingElse) {
  std::mt19937 random(2016);
  const std::string bytes = "0159.-+eE_ =[]{}\"'#,\n\t\\abmnixs\x01\x7f\xc3\xff";
  int refused = 0;
  for (int repeat = 0; repeat < 3000; ++repeat) {
    std::string text = k_good_scene;
    for (unsigned change = 0; change < 1 + static_cast<unsigned>(repeat) % 4; ++change) {
      const std::size_t at = random() % text.size();
      if (random() % 3 == 0)
        text.erase(at, 1 + random() % 9);
      else
        text[at] = bytes[random() % bytes.size()];
    }
    try {
      EXPECT_LE(particle_capacity(parse_scene(text, "mangled.toml")), std::int64_t{1} << 28);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith("mangled.toml:"));
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

/// A scene that a program built has no place in a file; the message begins with the cause.
class ChangedScene : public testing::Test {
 protected:
  Scene scene = parse_scene(k_good_scene, "good.toml");

  std::string refusal() const {
    try {
      validate(scene);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
};

TEST_F(ChangedScene, IsAcceptedUnchanged) { EXPECT_EQ(refusal(), "accepted"); }

TEST_F(ChangedScene, WithNotANumberIsRefused) {
  scene.fluid.spacing_m = std::nan("");
  EXPECT_THAT(refusal(), StartsWith("spacing_m = nan in [fluid] is out of range; allowed is 1e-04 to 10"));
}

TEST_F(ChangedScene, WithNotANumberInAVectorIsRefused) {
  scene.blocks[0].velocity_m_s.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(), StartsWith("velocity_m_s = nan in [[block]] 1 is out of range"));
}

TEST_F(ChangedScene, WithAnInfiniteLengthIsRefused) {
  scene.container.max_m.y() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(), StartsWith("max_m = inf in [container] is out of range"));
}

TEST_F(ChangedScene, WithParticlesOutsideTheContainerIsRefused) {
  scene.particle_files.push_back({"a.csv", {}});
  scene.particle_files[0].particles.add(0, {1.0, 1.0, 0.5}, {0, 0, 0});
  EXPECT_EQ(refusal(), "accepted");
  scene.particle_files[0].particles.add(1, {1.0, 1.0, 1.5}, {0, 0, 0});
  EXPECT_THAT(refusal(), StartsWith("particle 2 of 'a.csv' at (1, 1, 1.5) lies outside the container"));
}

TEST_F(ChangedScene, WithAParticleInABoxIsRefused) {
  scene.particle_files.push_back({"a.csv", {}});
  scene.particle_files[0].particles.add(0, {1.6, 0.1, 0.5}, {0, 0, 0});
  EXPECT_THAT(refusal(), StartsWith("particle 1 of 'a.csv' at (1.6, 0.1, 0.5) lies inside box 1"));
}

TEST_F(ChangedScene, WithAParticleThatIsNotFiniteIsRefused) {
  scene.particle_files.push_back({"a.csv", {}});
  scene.particle_files[0].particles.add(0, {1.0, std::nan(""), 0.5}, {0, 0, 0});
  EXPECT_THAT(refusal(), HasSubstr("lies outside the container"));
  scene.particle_files[0].particles.positions[0].y() = 1.0;
  scene.particle_files[0].particles.velocities[0].x() = std::nan("");
  EXPECT_THAT(refusal(), HasSubstr("has velocity (nan, 0, 0) m/s; allowed is up to 1000"));
}

TEST_F(ChangedScene, WithTwoParticlesInOnePlaceIsRefused) {
  scene.particle_files.push_back({"a.csv", {}});
  scene.particle_files.push_back({"b.csv", {}});
  squall::Particles& a = scene.particle_files[0].particles;
  squall::Particles& b = scene.particle_files[1].particles;
  a.add(0, {1.0, 1.0, 0.5}, {0, 0, 0});
  a.add(1, {1.0, 1.0, 0.6}, {0, 0, 0});
  b.add(0, {1.0, 1.0, 0.7}, {0, 0, 0});
  EXPECT_EQ(refusal(), "accepted");
  b.add(1, {1.0, 1.0, 0.6}, {1, 0, 0});
  EXPECT_THAT(refusal(), StartsWith("particle 2 of 'b.csv' at (1, 1, 0.6) lies in the same place as particle 2 of "
                                    "'a.csv' at (1, 1, 0.6): nothing could ever push them apart"));
  b.positions[1].z() = 0.6 + 1e-10;  // rounds to the same number in single precision
  EXPECT_THAT(refusal(), HasSubstr("lies in the same place"));
  b.positions[1].z() = 0.6 + 1e-6;
  EXPECT_EQ(refusal(), "accepted");
  b.positions[1] = squall::initial_particles(scene).positions[0] + scene.container.min_m;  // of the block
  EXPECT_THAT(refusal(), HasSubstr("lies in the same place as a particle of block 1"));
}

}  // namespace
