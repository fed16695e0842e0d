#include "core/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "core/checkpoint_file.h"
#include "core/errors.h"
#include "core/mix.h"
#include "core/state_hash.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Where fields lie, as docs/checkpoint.md says; not taken from the code under test.
constexpr std::size_t k_version = 8, k_number_bytes = 12, k_length = 16, k_particles = 24, k_rains = 32, k_text = 36,
                      k_pressure = 40, k_precision = 44, k_frame = 56, k_substeps = 64, k_next_id = 68, k_dt = 72,
                      k_speed = 80, k_energy = 96, k_rained = 104;

Scene rainy_tank() {
  Scene scene = filled_tank(2);
  scene.rains.push_back(rain_over_tank(300));
  return scene;
}

/// Two particles with numbers that only some precisions hold, signed zeros and a NaN among them.
Checkpoint odd_checkpoint(double fraction) {
  Checkpoint checkpoint;
  checkpoint.scene_text = checkpoint_scene_text(rainy_tank(), Pressure::dfsph);
  checkpoint.pressure = Pressure::dfsph;
  checkpoint.precision = Precision::double_precision;
  checkpoint.seed = 0xfedcba9876543210u;
  checkpoint.energy_in_j = -1.0 / 3;
  checkpoint.state.clock = {41, 17, 1.0 / 3600, 2.5, 123.0, 20, {3}};
  checkpoint.state.particles.add(7, {fraction, -0.0, double{1e30f}}, {1, 2, 3}, 4);
  checkpoint.state.particles.add(3, {4, 5, 6}, {std::numeric_limits<double>::quiet_NaN(), 8, 9}, 0);
  return checkpoint;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

void expect_same(const Checkpoint& a, const Checkpoint& b) {
  EXPECT_EQ(a.scene_text, b.scene_text);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.precision, b.precision);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(bits(a.energy_in_j), bits(b.energy_in_j));
  const Clock &x = a.state.clock, &y = b.state.clock;
  EXPECT_EQ(x.frame, y.frame);
  EXPECT_EQ(x.previous_substeps, y.previous_substeps);
  EXPECT_EQ(bits(x.previous_dt), bits(y.previous_dt));
  EXPECT_EQ(bits(x.max_speed), bits(y.max_speed));
  EXPECT_EQ(bits(x.max_acceleration), bits(y.max_acceleration));
  EXPECT_EQ(x.next_id, y.next_id);
  EXPECT_EQ(x.rained, y.rained);
  const Particles &p = a.state.particles, &q = b.state.particles;
  EXPECT_EQ(p.ids, q.ids);
  ASSERT_EQ(p.size(), q.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(bits(p.positions[i][axis]), bits(q.positions[i][axis])) << i;
      EXPECT_EQ(bits(p.velocities[i][axis]), bits(q.velocities[i][axis])) << i;
    }
    EXPECT_EQ(bits(p.pressures[i]), bits(q.pressures[i])) << i;
  }
}

template <class Value>
std::string patched(std::string bytes, std::size_t place, Value value) {
  std::memcpy(bytes.data() + place, &value, sizeof value);  // tests run on little-endian machines, like squall
  return bytes;
}

/// The documented checksum, written down a second time.
std::string sealed(std::string bytes) {
  const std::size_t content = bytes.size() - 8;
  std::uint64_t sum = mix64(content);
  for (std::size_t at = 0; at <= content / 8; ++at) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + 8 * at, std::min<std::size_t>(8, content - 8 * at));
    sum = mix64(sum ^ word);
  }
  return patched(bytes, content, sum);
}

std::string refusal(const std::string& bytes) {
  try {
    decode_checkpoint(bytes, "run.sqc");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string& good() {
  static const std::string bytes = encode_checkpoint(odd_checkpoint(0.5));
  return bytes;
}

TEST(Checkpoint, KeepsEveryBit) {
  for (const double fraction : {0.5, 0.1}) {
    const Checkpoint checkpoint = odd_checkpoint(fraction);
    expect_same(decode_checkpoint(encode_checkpoint(checkpoint), ""), checkpoint);
  }
}

TEST(Checkpoint, HoldsNoStateFromWithinAFrame) {
  Checkpoint checkpoint = odd_checkpoint(0.1);
  checkpoint.state.clock.substep = 2;
  EXPECT_THROW(encode_checkpoint(checkpoint), InputError);
}

TEST(Checkpoint, SingleNumbersTakeFourBytes) {
  const std::size_t text = odd_checkpoint(0).scene_text.size();
  EXPECT_EQ(good().size(), 104 + 8 + text + 2 * (4 + 7 * 4) + 8);
  EXPECT_EQ(encode_checkpoint(odd_checkpoint(0.1)).size(), 104 + 8 + text + 2 * (4 + 7 * 8) + 8);
}

TEST(Checkpoint, LiesAsDocumented) {
  const auto at = [](std::size_t place, auto value) {
    std::memcpy(&value, good().data() + place, sizeof value);
    return value;
  };
  EXPECT_EQ(good().substr(0, 8), "\x89squall\n");
  EXPECT_EQ(at(k_version, std::uint32_t{}), 1u);
  EXPECT_EQ(at(k_number_bytes, std::uint32_t{}), 4u);
  EXPECT_EQ(at(k_length, std::uint64_t{}), good().size());
  EXPECT_EQ(at(k_particles, std::uint64_t{}), 2u);
  EXPECT_EQ(at(k_rains, std::uint32_t{}), 1u);
  EXPECT_EQ(at(k_pressure, std::uint32_t{}), 2u);
  EXPECT_EQ(at(k_precision, std::uint32_t{}), 1u);
  EXPECT_EQ(at(k_frame, std::uint64_t{}), 41u);
  EXPECT_EQ(at(k_substeps, std::int32_t{}), 17);
  EXPECT_EQ(at(k_next_id, std::uint32_t{}), 20u);
  EXPECT_EQ(at(k_dt, double{}), 1.0 / 3600);
  EXPECT_EQ(at(k_energy, double{}), -1.0 / 3);
  EXPECT_EQ(at(k_rained, std::int64_t{}), 3);
  const std::size_t ids = k_rained + 8 + at(k_text, std::uint32_t{});
  EXPECT_EQ(at(ids, std::uint32_t{}), 7u);
  EXPECT_EQ(at(ids + 8, float{}), 0.5f);
  EXPECT_EQ(sealed(good()), good());
}

// Files of version 1, written when that was new, stay readable; what is in them is compared with what was printed then.
TEST(Checkpoint, OldFilesStayReadable) {
  const auto old = [](const char* name) {
    return read_checkpoint(SQUALL_SCENES_DIR "/../fuzz/corpus/checkpoint/" + std::string(name));
  };
  const Checkpoint one = old("single.sqc"), two = old("double.sqc");
  EXPECT_EQ(hash_text(state_hash(one.state.particles, Precision::single_precision)), "30f0f64cdf410253");
  EXPECT_EQ(hash_text(state_hash(two.state.particles, Precision::double_precision)), "9b93bddfcb966906");
  EXPECT_EQ(one.pressure, Pressure::wcsph);
  EXPECT_EQ(two.pressure, Pressure::dfsph);
  EXPECT_EQ(two.state.clock.frame, 5u);
  EXPECT_EQ(two.state.clock.rained, std::vector<std::int64_t>{8});
}

TEST(Checkpoint, AnEmptyStateIsOne) {
  Checkpoint nothing;
  expect_same(decode_checkpoint(encode_checkpoint(nothing), ""), nothing);
}

TEST(Checkpoint, AFileCutOffAnywhereIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  for (std::size_t length = 1; length < good().size(); ++length)
    ASSERT_THAT(refusal(good().substr(0, length)), StartsWith("run.sqc: is cut off: it has " + std::to_string(length)));
  EXPECT_THAT(refusal(good() + '\0'), HasSubstr("something was added"));
}

// One flipped bit, whichever: the checksum is a chain of bijections.
TEST(Checkpoint, EveryFlippedBitIsNoticed) {
  for (std::size_t bit = 0; bit < 8 * good().size(); ++bit) {
    std::string bytes = good();
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    ASSERT_NE(refusal(bytes), "accepted") << "bit " << bit;
  }
}

TEST(Checkpoint, ForeignFilesAreNamedAsSuch) {
  for (const std::string& text :
       {std::string("schema = 1\n"), std::string("\x89PNG\r\n\x1a\n........."), std::string(1000, '\0')})
    EXPECT_THAT(refusal(text), HasSubstr("is no squall checkpoint"));
}

TEST(Checkpoint, OtherVersionsAreNamed) {
  EXPECT_THAT(refusal(patched(good(), k_version, std::uint32_t{2})),
              HasSubstr("version 2; this squall reads version 1"));
  EXPECT_THAT(refusal(patched(good(), k_version, std::uint32_t{0})), HasSubstr("version 0"));
}

// Whole, and with the right checksum: what remains is what no run can have.
TEST(Checkpoint, HostileSizesAreRefusedBeforeAnythingIsAllocated) {
  for (const std::uint64_t count :
       {std::uint64_t{3}, std::uint64_t{1} << 28, std::uint64_t{1} << 32, std::uint64_t{1} << 63, ~std::uint64_t{0}})
    EXPECT_THAT(refusal(sealed(patched(good(), k_particles, count))), HasSubstr("is damaged: ")) << count;
  for (const std::uint32_t count : {0u, 2u, 1u << 16, ~0u}) {
    EXPECT_THAT(refusal(sealed(patched(good(), k_rains, count))), HasSubstr("is damaged: ")) << count;
    EXPECT_THAT(refusal(sealed(patched(good(), k_text, count))), HasSubstr("is damaged: ")) << count;
  }
  for (const std::uint32_t bytes : {0u, 1u, 8u, 16u, ~0u})
    EXPECT_THAT(refusal(sealed(patched(good(), k_number_bytes, bytes))), HasSubstr("is damaged: ")) << bytes;
  for (const std::uint64_t length : {std::uint64_t{0}, std::uint64_t{24}, std::uint64_t{111}}) {
    const std::string cut = patched(good(), k_length, length).substr(0, std::max<std::uint64_t>(length, 24));
    EXPECT_NE(refusal(cut), "accepted") << length;
  }
}

TEST(Checkpoint, ValuesThatNoRunHasAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refuses = [](const std::string& bytes, const char* what) {
    EXPECT_THAT(refusal(sealed(bytes)), HasSubstr(std::string("is damaged: no run has ") + what));
  };
  refuses(patched(good(), k_pressure, 3u), "pressure solver = 3");
  refuses(patched(good(), k_precision, 2u), "precision = 2");
  refuses(patched(good(), k_frame, ~std::uint64_t{0}), "frames");
  refuses(patched(good(), k_substeps, -1), "sub-steps = -1");
  refuses(patched(good(), k_substeps, 1001), "sub-steps = 1001");
  for (const double value : {-1.0, nan, infinity, 11.0}) refuses(patched(good(), k_dt, value), "time step");
  for (const double value : {-1.0, nan, infinity}) refuses(patched(good(), k_speed, value), "largest speed");
  for (const double value : {-1.0, nan, infinity}) refuses(patched(good(), k_speed + 8, value), "largest acceleration");
  for (const double value : {-infinity, nan, infinity}) refuses(patched(good(), k_energy, value), "energy");
  refuses(patched(good(), k_rained, std::int64_t{-1}), "drops = -1");
  refuses(patched(good(), k_next_id, ~0u), "next id");
  EXPECT_THAT(refusal(sealed(patched(good(), k_next_id, 7u))), HasSubstr("has a particle 7"));
}

std::string origin_error(const Scene& saved, const Scene& given, const Settings& settings = {}) {
  Checkpoint checkpoint;
  checkpoint.scene_text = checkpoint_scene_text(saved, Pressure::dfsph);
  try {
    check_origin(checkpoint, given, settings, "run.sqc");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckpointOrigin, TheSameWaterIsAccepted) {
  const Scene scene = rainy_tank();
  Scene longer = scene;
  longer.time.duration_s *= 2;
  longer.name = "another file";
  longer.gauges.push_back({"g", {0.1, 0.1, 0.1}, "level"});
  EXPECT_EQ(origin_error(scene, scene), "");
  EXPECT_EQ(origin_error(scene, longer), "");
}

TEST(CheckpointOrigin, WhatDiffersIsNamed) {
  const Scene scene = rainy_tank();
  Scene other = scene;
  other.fluid.spacing_m = 0.04;
  EXPECT_THAT(origin_error(scene, other), HasSubstr("[fluid] spacing_m is 0.05 there and 0.04 here"));
  other = scene;
  other.blocks.push_back(scene.blocks[0]);
  EXPECT_THAT(origin_error(scene, other), HasSubstr("[[block]] 2 min_m is not set there"));
  EXPECT_THAT(origin_error(other, scene), HasSubstr("[[block]] 2 min_m is [0.0, 0.0, 0.0] there and not set here"));
  Settings settings;
  settings.pressure = Pressure::mueller;
  EXPECT_THAT(origin_error(scene, scene, settings), HasSubstr("add --pressure dfsph"));
  settings = {};
  settings.seed = 2;
  EXPECT_THAT(origin_error(scene, scene, settings), HasSubstr("add --seed 1"));
  EXPECT_EQ(origin_error(filled_tank(1), filled_tank(1), settings), "") << "no rain, no seed";
}

TEST(CheckpointOrigin, ParticleFilesCountByWhatIsInThem) {
  Particles one, two;
  one.add(0, {0.1, 0.1, 0.1}, {0, 0, 0});
  two.add(0, {0.1, 0.1, 0.2}, {0, 0, 0});
  Scene renamed = tank_with(one);
  renamed.particle_files[0].file = "elsewhere.csv";
  EXPECT_EQ(origin_error(tank_with(one), renamed), "");
  EXPECT_THAT(origin_error(tank_with(one), tank_with(two)), HasSubstr("[[particles]] file"));
}

}  // namespace
}  // namespace squall::test
