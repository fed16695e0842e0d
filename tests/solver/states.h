#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include "core/solver.h"
#include "support/scenes.h"

namespace squall::test {

/// A state by id, for comparing solvers whatever their order.
struct Motion {
  Eigen::Vector3d position, velocity;
};
inline std::map<std::uint32_t, Motion> by_id(const Particles& particles) {
  std::map<std::uint32_t, Motion> motions;
  for (std::size_t i = 0; i < particles.size(); ++i)
    motions[particles.ids[i]] = {particles.positions[i], particles.velocities[i]};
  return motions;
}

inline bool all_finite(const Particles& particles) {
  const auto finite = [](const Eigen::Vector3d& v) { return v.allFinite(); };
  return std::all_of(particles.positions.begin(), particles.positions.end(), finite) &&
         std::all_of(particles.velocities.begin(), particles.velocities.end(), finite);
}

/// Where two states differ first, in the order of the particles; empty if they are equal to the last bit.
inline std::string first_difference(const Particles& a, const Particles& b) {
  if (a.size() != b.size()) return std::to_string(a.size()) + " and " + std::to_string(b.size()) + " particles";
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::string at = "place " + std::to_string(i) + ": ";
    if (a.ids[i] != b.ids[i]) return at + "ids " + std::to_string(a.ids[i]) + " and " + std::to_string(b.ids[i]);
    if (a.positions[i] != b.positions[i] || a.velocities[i] != b.velocities[i]) {
      const Eigen::IOFormat full(Eigen::FullPrecision, Eigen::DontAlignCols, " ", " ");
      std::ostringstream text;
      text << at << "id " << a.ids[i] << ": x " << a.positions[i].format(full) << " and " << b.positions[i].format(full)
           << ", v " << a.velocities[i].format(full) << " and " << b.velocities[i].format(full);
      return text.str();
    }
    if (a.pressures[i] != b.pressures[i])
      return at + "pressures " + std::to_string(a.pressures[i]) + " and " + std::to_string(b.pressures[i]);
  }
  return "";
}

/// `count` particles, random in [low, high], at rest or with velocities up to `speed` per component. Single-precision
/// values, so that every backend starts from the same.
inline Particles random_particles(std::size_t count, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                  double speed, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto single = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  Particles particles;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d x, v;
    for (int axis = 0; axis < 3; ++axis) x[axis] = single(low[axis] + unit(random) * (high[axis] - low[axis]));
    for (int axis = 0; axis < 3; ++axis) v[axis] = single(speed * (2 * unit(random) - 1));
    particles.add(static_cast<std::uint32_t>(i), x, v);
  }
  return particles;
}

/// `edge`^3 particles on a lattice from `corner`, each off its place by up to `jitter` and stirred by up to `speed` per
/// component. Single-precision values.
inline Particles shaken_lattice(int edge, double spacing, const Eigen::Vector3d& corner, double jitter, double speed,
                                unsigned seed) {
  const auto count = static_cast<std::size_t>(edge * edge * edge);
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(jitter);
  Particles particles = random_particles(count, -reach, reach, speed, seed);
  for (std::size_t i = 0; i < count; ++i) {
    const int n = static_cast<int>(i);
    const Eigen::Vector3d place(n % edge, n / edge % edge, n / (edge * edge));
    particles.positions[i] = (particles.positions[i] + corner + spacing * place).cast<float>().cast<double>();
  }
  return particles;
}

/// A tank with room for `count` particles that a test loads itself, and one sub-step per frame of 1/4000 s: what a
/// frame does is then what a sub-step does. Heaps of particles would iterate for long without an end: three iterations
/// show as much.
inline Scene one_substep_tank(std::size_t count) {
  const Eigen::Vector3d size = empty_tank().container_size();
  Scene scene = tank_with(random_particles(count, 0.25 * size, 0.75 * size, 0, 1));
  scene.time.frame_rate_hz = 1000;
  scene.solver.speed_of_sound_m_s = 20;
  scene.solver.max_iterations = 3;
  return scene;
}

}  // namespace squall::test
