#include "core/fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/errors.h"
#include "core/scene_keys.h"

namespace squall {
namespace {

/// Lattice indices [first, end) on each axis.
struct IndexBox {
  std::array<std::int64_t, 3> first, end;

  bool contains(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return i >= first[0] && i < end[0] && j >= first[1] && j < end[1] && k >= first[2] && k < end[2];
  }
};

/// The points that fill a block, in container coordinates, and the boxes in which there are none.
struct Lattice {
  Eigen::Vector3d corner;
  double spacing;
  std::array<std::int64_t, 3> counts;
  std::vector<IndexBox> solids;

  Eigen::Vector3d point(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const Eigen::Vector3d index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    return corner + spacing * (index + Eigen::Vector3d::Constant(0.5));
  }
  std::int64_t size() const { return counts[0] * counts[1] * counts[2]; }
};

/// Lattice points inside a solid box; one on a face counts as inside.
IndexBox indices_within(const Lattice& lattice, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double touch) {
  IndexBox result{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto index_of = [&](double at) { return (at - lattice.corner[axis]) / lattice.spacing - 0.5; };
    const auto most = static_cast<double>(lattice.counts[a]);
    result.first[a] = static_cast<std::int64_t>(std::clamp(std::ceil(index_of(low[axis] - touch)), 0.0, most));
    result.end[a] = static_cast<std::int64_t>(std::clamp(std::floor(index_of(high[axis] + touch)) + 1.0, 0.0, most));
  }
  return result;
}

Lattice block_lattice(const Scene& scene, const Scene::Block& block) {
  const double spacing = scene.fluid.spacing_m;
  const Eigen::Vector3d size = block.max_m - block.min_m;
  Lattice lattice{block.min_m - scene.container.min_m,
                  spacing,
                  {layers(size.x(), spacing), layers(size.y(), spacing), layers(size.z(), spacing)},
                  {}};
  for (const Scene::SolidBox& box : scene.boxes) {
    const IndexBox solid = indices_within(lattice, box.min_m - scene.container.min_m, box.max_m - scene.container.min_m,
                                          length_tolerance(scene));
    if (solid.first[0] < solid.end[0] && solid.first[1] < solid.end[1] && solid.first[2] < solid.end[2])
      lattice.solids.push_back(solid);
  }
  return lattice;
}

/// Points in the union of boxes, by slabs between the boxes' faces on one axis after the other.
std::int64_t covered_points(const std::vector<IndexBox>& boxes, std::size_t axis = 0) {
  if (boxes.empty()) return 0;
  if (axis == 3) return 1;
  std::vector<std::int64_t> cuts;
  for (const IndexBox& box : boxes) cuts.insert(cuts.end(), {box.first[axis], box.end[axis]});
  std::sort(cuts.begin(), cuts.end());
  std::int64_t count = 0;
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    if (cuts[c] == cuts[c + 1]) continue;
    std::vector<IndexBox> within;
    for (const IndexBox& box : boxes)
      if (box.first[axis] <= cuts[c] && box.end[axis] >= cuts[c + 1]) within.push_back(box);
    count += (cuts[c + 1] - cuts[c]) * covered_points(within, axis + 1);
  }
  return count;
}

template <class Use>
void for_each_point(const Lattice& lattice, Use&& use) {
  for (std::int64_t k = 0; k < lattice.counts[2]; ++k)
    for (std::int64_t j = 0; j < lattice.counts[1]; ++j)
      for (std::int64_t i = 0; i < lattice.counts[0]; ++i) {
        const auto holds_point = [&](const IndexBox& solid) { return solid.contains(i, j, k); };
        if (std::none_of(lattice.solids.begin(), lattice.solids.end(), holds_point)) use(lattice.point(i, j, k));
      }
}

}  // namespace

std::int64_t block_points(const Scene& scene, const Scene::Block& block) {
  const Lattice lattice = block_lattice(scene, block);
  return lattice.size() - covered_points(lattice.solids);
}

std::int64_t layers(double length, double spacing) {
  return static_cast<std::int64_t>(std::max(0.0, std::floor(length / spacing + 1e-6)));
}

double lattice_points(const Scene& scene) {
  double points = 0.0;
  for (const Scene::Block& block : scene.blocks) {
    const Lattice lattice = block_lattice(scene, block);
    points += static_cast<double>(lattice.counts[0]) * static_cast<double>(lattice.counts[1]) *
              static_cast<double>(lattice.counts[2]);
  }
  return points;
}

double length_tolerance(const Scene& scene) { return 1e-6 * scene.fluid.spacing_m; }

BlockPair overlapping_blocks(const Scene& scene) {
  const double touch = length_tolerance(scene);
  for (std::size_t second = 1; second < scene.blocks.size(); ++second)
    for (std::size_t first = 0; first < second; ++first) {
      const Eigen::Vector3d low = scene.blocks[first].min_m.cwiseMax(scene.blocks[second].min_m);
      const Eigen::Vector3d high = scene.blocks[first].max_m.cwiseMin(scene.blocks[second].max_m);
      if (((high - low).array() > touch).all()) return {first, second};
    }
  return {};
}

Particles initial_particles(const Scene& scene) {
  const BlockPair pair = overlapping_blocks(scene);
  if (pair.first != pair.second)
    throw InputError("block " + std::to_string(pair.second + 1) + " overlaps block " + std::to_string(pair.first + 1) +
                     "; move them apart");
  Particles particles;
  const auto next_id = [&] { return static_cast<std::uint32_t>(particles.size()); };
  for (const Scene::Block& block : scene.blocks) {
    const Lattice lattice = block_lattice(scene, block);
    particles.reserve(particles.size() + static_cast<std::size_t>(lattice.size()));
    for_each_point(lattice, [&](const Eigen::Vector3d& point) { particles.add(next_id(), point, block.velocity_m_s); });
  }
  for (const Scene::ParticleFile& particle_file : scene.particle_files)
    for (std::size_t i = 0; i < particle_file.particles.positions.size(); ++i)
      particles.add(next_id(), particle_file.particles.positions[i] - scene.container.min_m,
                    particle_file.particles.velocities[i]);
  return particles;
}

std::int64_t particle_capacity(const Scene& scene) {
  std::int64_t count = 0;
  for (const Scene::Block& block : scene.blocks) count += block_points(scene, block);
  for (const Scene::ParticleFile& particle_file : scene.particle_files)
    count += static_cast<std::int64_t>(particle_file.particles.positions.size());
  for (const Scene::Rain& rain : scene.rains) count += rain.max_particles;
  return count;
}

}  // namespace squall
