#include "harness/measures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "grid.h"
#include "harness/present.h"
#include "harness/statistics.h"

namespace squall::harness {

namespace {

double energy_of(const Scene& scene, const Eigen::Vector3d& x, const Eigen::Vector3d& v) {
  return scene.particle_mass() * (0.5 * v.squaredNorm() - scene.gravity_m_s2.dot(x));
}

double front_of(const std::vector<Eigen::Vector3d>& free, double spacing) {
  std::vector<double> low;
  for (const auto& x : free)
    if (x.y() < 2.0 * spacing) low.push_back(x.x());
  return low.empty() ? k_no_value : quantile(std::move(low), 0.97) + 0.5 * spacing;
}

/// Spray that has no neighbour is no water surface.
double height_of(const std::vector<Eigen::Vector3d>& free, double spacing, double support_radius) {
  std::vector<Eigen::Vector3d> near_wall;
  for (const auto& x : free)
    if (x.x() < support_radius) near_wall.push_back(x);
  std::sort(near_wall.begin(), near_wall.end(), [](const auto& a, const auto& b) { return a.y() > b.y(); });
  const double reach = support_radius * support_radius;
  for (const auto& top : near_wall) {
    const auto neighbours =
        std::count_if(free.begin(), free.end(), [&](const auto& x) { return (x - top).squaredNorm() < reach; });
    if (neighbours > 1) return top.y() + 0.5 * spacing;
  }
  return k_no_value;
}

}  // namespace

Observation observe(const Scene& scene, const Particles& particles, double time_s) {
  Observation result;
  result.time_s = time_s;
  const Present present(scene, time_s);
  std::vector<Eigen::Vector3d> free;
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto& x = particles.positions[i];
    const auto& v = particles.velocities[i];
    if (is_lost(x.x())) continue;
    count += 1.0;
    sum += x;
    result.kinetic_j += energy_of(scene, Eigen::Vector3d::Zero(), v);
    result.potential_j += energy_of(scene, x, Eigen::Vector3d::Zero());
    if (!present.is_held(particles.ids[i])) free.push_back(x);
  }
  if (count > 0.0) result.centre_m = sum / count;
  const double dx = scene.fluid.spacing_m;
  result.front_m = front_of(free, dx);
  for (const auto& x : free) result.front_max_m = std::fmax(result.front_max_m, x.x() + 0.5 * dx);  // of NaN and x: x
  result.height_m = height_of(free, dx, scene.support_radius());
  return result;
}

double total_energy(const Scene& scene, const Particles& particles, std::uint32_t first_id) {
  double sum = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles.ids[i] >= first_id && !is_lost(particles.positions[i].x()))
      sum += energy_of(scene, particles.positions[i], particles.velocities[i]);
  return sum;
}

bool is_finite(const Particles& particles) {
  const auto finite = [](const Eigen::Vector3d& value) { return value.allFinite(); };
  return std::all_of(particles.positions.begin(), particles.positions.end(), finite) &&
         std::all_of(particles.velocities.begin(), particles.velocities.end(), finite);
}

}  // namespace squall::harness
