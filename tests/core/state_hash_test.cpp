#include "core/state_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace squall::test {
namespace {

Particles random_particles(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  Particles particles;
  const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  for (std::size_t i = 0; i < count; ++i) particles.add(static_cast<std::uint32_t>(i), vector(), vector());
  return particles;
}

Particles reordered(const Particles& particles, const std::vector<std::size_t>& order) {
  Particles out;
  for (const std::size_t i : order) out.add(particles.ids[i], particles.positions[i], particles.velocities[i]);
  return out;
}

constexpr Precision k_single = Precision::single_precision, k_double = Precision::double_precision;

TEST(StateHash, DoesNotDependOnTheOrder) {
  for (const std::size_t count : {1u, 2u, 63u, 64u, 65u, 1000u}) {
    const Particles particles = random_particles(count, 1);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::mt19937 random(2);
    for (int turn = 0; turn < 5; ++turn) {
      std::shuffle(order.begin(), order.end(), random);
      for (const Precision precision : {k_single, k_double})
        EXPECT_EQ(state_hash(reordered(particles, order), precision), state_hash(particles, precision));
    }
  }
}

TEST(StateHash, SeesOneLastBitOfAnyNumberOfAnyParticle) {
  const Particles particles = random_particles(65, 3);
  std::set<std::uint64_t> seen = {state_hash(particles, k_single)};
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (const bool velocity : {false, true}) {
        Particles changed = particles;
        double& number = (velocity ? changed.velocities : changed.positions)[i][axis];
        number = std::nextafter(static_cast<float>(number), 2.0f);
        EXPECT_TRUE(seen.insert(state_hash(changed, k_single)).second) << i << ", axis " << axis;
      }
}

TEST(StateHash, SeesWhichParticleIsWhere) {
  const Particles particles = random_particles(2, 4);
  Particles swapped = particles;
  std::swap(swapped.ids[0], swapped.ids[1]);
  EXPECT_NE(state_hash(swapped, k_single), state_hash(particles, k_single));
  Particles turned = particles;
  std::swap(turned.positions[0].x(), turned.positions[0].y());
  EXPECT_NE(state_hash(turned, k_single), state_hash(particles, k_single));
  Particles exchanged = particles;
  std::swap(exchanged.positions[0], exchanged.velocities[0]);
  EXPECT_NE(state_hash(exchanged, k_single), state_hash(particles, k_single));
}

TEST(StateHash, CountsEveryParticle) {
  const Particles particles = random_particles(3, 5);
  EXPECT_NE(state_hash(reordered(particles, {0, 1}), k_single), state_hash(particles, k_single));
  EXPECT_EQ(state_hash(Particles{}, k_single), state_hash(Particles{}, k_double));
}

// The precision says which bits count: what single precision rounds away is not seen in single precision only.
TEST(StateHash, LooksAtTheBitsOfItsPrecision) {
  const Particles particles = random_particles(5, 6);
  Particles changed = particles;
  changed.positions[2].x() = std::nextafter(changed.positions[2].x(), 2.0);
  EXPECT_EQ(state_hash(changed, k_single), state_hash(particles, k_single));
  EXPECT_NE(state_hash(changed, k_double), state_hash(particles, k_double));
  Particles zero = particles, minus_zero = particles;
  zero.positions[0].x() = 0.0;
  minus_zero.positions[0].x() = -0.0;
  for (const Precision precision : {k_single, k_double})
    EXPECT_NE(state_hash(zero, precision), state_hash(minus_zero, precision)) << "equal numbers, different bits";
}

TEST(StateHash, IsWrittenWithSixteenDigits) {
  EXPECT_EQ(hash_text(0), "0000000000000000");
  EXPECT_EQ(hash_text(0x0123456789abcdefu), "0123456789abcdef");
  EXPECT_EQ(hash_text(std::numeric_limits<std::uint64_t>::max()), "ffffffffffffffff");
}

}  // namespace
}  // namespace squall::test
