#include "harness/water_field.h"

#include <algorithm>

#include "core/reference_dfsph.h"
#include "core/reference_passes.h"
#include "core/smoothing_kernels.h"
#include "harness/present.h"

namespace squall::harness {

namespace {

using Sorted = reference::SortedParticles<double>;

bool is_near(const std::vector<Eigen::Vector3d>& places, const Eigen::Vector3d& x, double reach) {
  return std::any_of(places.begin(), places.end(),
                     [&](const auto& place) { return (x - place).cwiseAbs().maxCoeff() <= reach; });
}

Eigen::Vector3d vector_of(const double* values) { return {values[0], values[1], values[2]}; }

Sorted sorted_near(const Scene& scene, const Params<double>& params, const State& state,
                   const std::vector<Eigen::Vector3d>& places, double reach) {
  const Particles& from = state.particles;
  const Present present(scene, time_of(scene, state));
  Sorted sorted;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!present.is_free(from, i) || !is_near(places, from.positions[i], reach)) continue;
    reference::Particle<double> particle;
    particle.id = from.ids[i];
    for (int axis = 0; axis < 3; ++axis) {
      particle.x[axis] = from.positions[i][axis];
      particle.v[axis] = from.velocities[i][axis];
    }
    particle.pressure = from.pressures.empty() ? 0.0 : from.pressures[i];
    sorted.particles.push_back(particle);
  }
  reference::sort(params, {}, 0, sorted);
  return sorted;
}

/// Acceleration that the walls give particle i, whose density (or dfsph's preparation) is known: the wall part of the
/// reference's force passes.
Eigen::Vector3d wall_acceleration(const Params<double>& params, Pressure pressure,
                                  const reference::Walls<double>& walls, const reference::Particle<double>& particle) {
  if (pressure == Pressure::dfsph) return particle.pressure * vector_of(particle.opening_gradient);
  double gradient[3];
  reference::opening(params, force_kernel(pressure), false, walls, particle.x, gradient);
  const double push = pressure == Pressure::mueller ? particle.pressure / particle.density : particle.pressure_term;
  return push * vector_of(gradient);
}

}  // namespace

double time_of(const Scene& scene, const State& state) {
  return static_cast<double>(state.clock.frame) / scene.time.frame_rate_hz;
}

int standing_boxes(const Scene& scene, double time_s) {
  const double reached = time_s + 1e-6 / scene.time.frame_rate_hz;
  return static_cast<int>(std::count_if(scene.boxes.begin(), scene.boxes.end(), [&](const Scene::SolidBox& box) {
    return !box.until_s || *box.until_s > reached;
  }));
}

WaterField::WaterField(const Scene& scene, Pressure pressure)
    : scene_(scene), pressure_(pressure), params_(make_params(scene, pressure)), boxes_(make_boxes(scene, pressure)) {}

std::vector<WaterPoint> WaterField::around(const State& state, const std::vector<Eigen::Vector3d>& places,
                                           double reach) const {
  std::vector<WaterPoint> points;
  if (places.empty()) return points;
  Sorted sorted = sorted_near(scene_, params_, state, places, reach + scene_.support_radius());
  const reference::Walls<double> walls{boxes_.data(), standing_boxes(scene_, time_of(scene_, state))};
  const reference::Terms terms{pressure_};
  for (int i = 0; i < sorted.active(); ++i) {
    auto& particle = sorted.particles[static_cast<std::size_t>(i)];
    if (!is_near(places, vector_of(particle.x), reach)) continue;
    if (pressure_ == Pressure::dfsph)
      reference::prepare(params_, walls, sorted, i);
    else
      reference::density(params_, terms, walls, sorted, i);
    points.push_back({vector_of(particle.x), vector_of(particle.v), scene_.fluid.rest_density_kg_m3 * particle.pressure,
                      wall_acceleration(params_, pressure_, walls, particle)});
  }
  return points;
}

}  // namespace squall::harness
