#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace squall {

/// The state that survives a step, in its current order: the order is part of it, and every backend continues from it
/// to the same sums. Positions [m] are relative to the container's min corner and in its frame; velocities [m/s] belong
/// to the middle of the last sub-step (leap-frog). Doubles hold single-precision states exactly. All arrays have the
/// same length. Lost particles come last.
///
/// `pressures` are p/rho0 [m^2/s^2] as dfsph left them: what its next sub-step starts from. Other pressure solvers
/// leave them 0. As input they may be left out altogether (no element): all 0.
struct Particles {
  std::vector<std::uint32_t> ids;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> velocities;
  std::vector<double> pressures;

  std::size_t size() const { return ids.size(); }
  void reserve(std::size_t count) {
    ids.reserve(count);
    positions.reserve(count);
    velocities.reserve(count);
    pressures.reserve(count);
  }
  void add(std::uint32_t id, const Eigen::Vector3d& position, const Eigen::Vector3d& velocity, double pressure = 0.0) {
    ids.push_back(id);
    positions.push_back(position);
    velocities.push_back(velocity);
    pressures.push_back(pressure);
  }
};

}  // namespace squall
