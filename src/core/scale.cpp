#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "core/errors.h"
#include "core/fill.h"
#include "core/scene.h"
#include "core/scene_keys.h"

namespace squall {
namespace {

/// The scene at another spacing; rain keeps its mass per second and its mass in all.
Scene respaced(const Scene& scene, double spacing) {
  Scene result = scene;
  const double ratio = scene.fluid.spacing_m / spacing;
  const double more = ratio * ratio * ratio;
  result.fluid.spacing_m = spacing;
  for (Scene::Rain& rain : result.rains) {
    const double limit = 2.0 * static_cast<double>(scene_keys::k_max_particles);
    const double wanted = std::min(static_cast<double>(rain.max_particles) * more, limit);
    rain.max_particles = std::llround(wanted);
    if (rain.particles_per_s) *rain.particles_per_s *= more;
  }
  return result;
}

/// Edge that the spacing divides, and how many layers on it are legal: every block and the container keep room for one
/// particle, and the spacing stays in its range.
struct LayerRange {
  double edge = 0.0;
  std::int64_t fewest = 1, most = 1;
};

LayerRange layer_range(const Scene& scene) {
  const Eigen::Vector3d base = scene.container_size();
  LayerRange range;
  double thinnest = base.minCoeff();
  for (const Scene::Block& block : scene.blocks) thinnest = std::min(thinnest, (block.max_m - block.min_m).minCoeff());
  range.edge = scene.blocks.empty() ? std::min(base.x(), base.z())
                                    : (scene.blocks.front().max_m - scene.blocks.front().min_m).minCoeff();
  range.fewest = std::max<std::int64_t>(1, std::llround(std::ceil(range.edge / std::min(thinnest, 10.0) - 1e-6)));
  range.most = std::max(range.fewest, layers(range.edge, 1e-4));
  return range;
}

/// The spacing for n layers on the edge; the scene's own if that is n layers already but for rounding, so that scaling
/// to the count a scene has changes nothing.
double spacing_for(const Scene& scene, const LayerRange& range, std::int64_t n) {
  const double spacing = range.edge / static_cast<double>(n);
  return std::abs(spacing - scene.fluid.spacing_m) <= 1e-9 * spacing ? scene.fluid.spacing_m : spacing;
}

/// Particles with n layers on the edge; beyond the limit of a scene, only that there are too many.
std::int64_t count_with_layers(const Scene& scene, const LayerRange& range, std::int64_t n) {
  const Scene changed = respaced(scene, spacing_for(scene, range, n));
  const auto limit = static_cast<double>(scene_keys::k_max_particles);
  if (lattice_points(changed) > limit) return 2 * scene_keys::k_max_particles;
  return particle_capacity(changed);
}

void refuse_unscalable(const Scene& scene, std::int64_t particles) {
  if (particles < 1 || particles > scene_keys::k_max_particles)
    throw InputError("a scene cannot be scaled to " + std::to_string(particles) + " particles; allowed is 1 to " +
                     std::to_string(scene_keys::k_max_particles));
  if (!scene.particle_files.empty())
    throw InputError("scene '" + scene.name + "' cannot be scaled: the particles of '" +
                     scene.particle_files.front().file + "' have their spacing; leave the particle count alone");
  if (particle_capacity(scene) == 0)
    throw InputError("scene '" + scene.name + "' cannot be scaled: it has neither blocks nor rain");
}

}  // namespace

std::int64_t scale_to_particles(Scene& scene, std::int64_t particles) {
  refuse_unscalable(scene, particles);
  const LayerRange range = layer_range(scene);
  // More layers mean more particles, but for what boxes take away and rounding adds: bisect, then look around.
  std::int64_t low = range.fewest, high = range.most;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (count_with_layers(scene, range, middle) >= particles)
      high = middle;
    else
      low = middle + 1;
  }
  std::int64_t best = 0, best_distance = 0;
  for (std::int64_t n = std::max(range.fewest, low - 2); n <= std::min(range.most, low + 2); ++n) {
    const std::int64_t distance = std::abs(count_with_layers(scene, range, n) - particles);
    if (best != 0 && distance >= best_distance) continue;
    best = n;
    best_distance = distance;
  }
  Scene scaled = respaced(scene, spacing_for(scene, range, best));
  validate(scaled);
  scene = std::move(scaled);
  return particle_capacity(scene);
}

}  // namespace squall
