#include "harness/stress/lattice_modes.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/frame_plan.h"
#include "core/smoothing_kernels.h"
#include "sph_formulas.h"

namespace squall::harness {

namespace {

constexpr double k_pi = std::numbers::pi;

/// A neighbour on the lattice; lengths in units of the support radius.
struct Neighbour {
  Eigen::Vector3d offset;
  double r = 0.0;
};

std::vector<Neighbour> neighbours_of(double support_ratio) {
  std::vector<Neighbour> neighbours;
  const int reach = static_cast<int>(std::ceil(support_ratio));
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const Eigen::Vector3d offset = Eigen::Vector3d(x, y, z) / support_ratio;
        const double r = offset.norm();
        if (r > 0.0 && r < 1.0) neighbours.push_back({offset, r});
      }
  return neighbours;
}

/// -dW/dr at distance r of a kernel with support 1.
double slope(int kernel, double r) {
  const double u = 1.0 - r, t = 1.0 - r * r;
  switch (kernel) {
    case SQUALL_POLY6:
      return 945.0 / (32.0 * k_pi) * r * t * t;
    case SQUALL_SPIKY:
      return 45.0 / k_pi * u * u;
    case SQUALL_BELL:
      return 945.0 / (2048.0 * k_pi) * r * bell_weight(t);
    default:
      return 48.0 / k_pi * cubic_slope(u, std::max(0.0, 1.0 - 2.0 * r));
  }
}

/// Density that a wave of unit displacement makes, per direction: sum V (-W') sin(k.x) x/r.
Eigen::Vector3d gradient(int kernel, double volume, const std::vector<Neighbour>& neighbours,
                         const Eigen::Vector3d& wave) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& n : neighbours) sum += volume * slope(kernel, n.r) * std::sin(wave.dot(n.offset)) / n.r * n.offset;
  return sum;
}

/// Factor of nu (1 - cos k.x) (x x)/r^2 of a pair, or of the unit matrix for mueller (docs/physics.md, docs/dfsph.md).
double viscous_weight(Pressure pressure, double volume, double r) {
  constexpr double k_softening = 0.01 * 0.25;
  switch (pressure) {
    case Pressure::mueller:
      return volume * 45.0 / k_pi * (1.0 - r);
    case Pressure::wcsph:
      return 10.0 * volume * slope(SQUALL_CUBIC, r) * r / (r * r + k_softening);
    case Pressure::dfsph:
      break;
  }
  return 187.0 / 7.0 * volume * slope(SQUALL_BELL, r) * r;
}

double viscous_eigenvalue(Pressure pressure, double volume, const std::vector<Neighbour>& neighbours,
                          const Eigen::Vector3d& wave) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (const auto& n : neighbours) {
    const double weight = viscous_weight(pressure, volume, n.r) * (1.0 - std::cos(wave.dot(n.offset)));
    if (pressure == Pressure::mueller)
      matrix += weight * Eigen::Matrix3d::Identity();
    else
      matrix += weight / (n.r * n.r) * n.offset * n.offset.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

}  // namespace

LatticeModes lattice_modes(Pressure pressure, double support_ratio) {
  const auto neighbours = neighbours_of(support_ratio);
  const double cube = 1.0 / (support_ratio * support_ratio * support_ratio);
  const double density_volume = cube / lattice_sum(density_kernel(pressure), support_ratio);
  // mueller takes forces as they are printed, half a gradient and not divided by any sum of the lattice.
  const double force_volume = pressure == Pressure::mueller ? 0.5 * cube : density_volume;
  const double viscous_volume = pressure == Pressure::mueller ? cube : density_volume;
  constexpr int k_waves = 32;
  double sound = 0.0;
  LatticeModes modes;
  for (int x = 0; x <= k_waves; ++x)
    for (int y = 0; y <= x; ++y)
      for (int z = 0; z <= y; ++z) {
        const Eigen::Vector3d wave = k_pi / k_waves * support_ratio * Eigen::Vector3d(x, y, z);
        modes.viscosity = std::max(modes.viscosity, viscous_eigenvalue(pressure, viscous_volume, neighbours, wave));
        if (pressure == Pressure::dfsph) continue;
        sound = std::max(sound, gradient(density_kernel(pressure), density_volume, neighbours, wave)
                                    .dot(gradient(force_kernel(pressure), force_volume, neighbours, wave)));
      }
  modes.sound = std::sqrt(sound);
  return modes;
}

}  // namespace squall::harness
