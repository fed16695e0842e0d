#include "harness/validation/water.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "grid.h"
#include "harness/measures.h"
#include "harness/present.h"
#include "harness/water_field.h"

namespace squall::harness {

namespace {

/// Finds out who has a neighbour within a distance: cells as long as that, in a hash table, since water may be
/// anywhere.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<Eigen::Vector3d>& positions, double reach) : positions_(positions), reach_(reach) {
    for (std::size_t i = 0; i < positions.size(); ++i) cells_[key(cell_of(positions[i]))].push_back(i);
  }

  bool has_neighbour(std::size_t i) const {
    const auto cell = cell_of(positions_[i]);
    for (std::int64_t z = -1; z <= 1; ++z)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t x = -1; x <= 1; ++x)
          if (has_neighbour_in(key({cell[0] + x, cell[1] + y, cell[2] + z}), i)) return true;
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Eigen::Vector3d& x) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(x[axis] / reach_));
    return cell;
  }
  /// 21 bits an axis: cells that share a key only cost time.
  static std::uint64_t key(const Cell& cell) {
    constexpr std::uint64_t k_mask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(cell[0]) & k_mask) | (static_cast<std::uint64_t>(cell[1]) & k_mask) << 21 |
           (static_cast<std::uint64_t>(cell[2]) & k_mask) << 42;
  }
  bool has_neighbour_in(std::uint64_t cell, std::size_t i) const {
    const auto found = cells_.find(cell);
    return found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), [&](std::size_t j) {
             return j != i && (positions_[j] - positions_[i]).squaredNorm() < reach_ * reach_;
           });
  }

  const std::vector<Eigen::Vector3d>& positions_;
  double reach_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& positions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& x : positions) sum += x;
  return sum / static_cast<double>(positions.size());
}

void fill_depths(const Scene& scene, const std::vector<Eigen::Vector3d>& positions, Water& water) {
  const Neighbourhood neighbourhood(positions, scene.support_radius());
  double count = 0.0, height = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!neighbourhood.has_neighbour(i)) continue;
    count += 1.0;
    height += positions[i].y();
  }
  const Eigen::Vector3d size = scene.container_size();
  if (count > 0.0) water.depth = 2.0 * height / count;
  water.filled_depth = count * scene.particle_volume() / (size.x() * size.z());
}

double distortion_of(const State& state, const Particles& start) {
  std::unordered_map<std::uint32_t, Eigen::Vector3d> places;
  for (std::size_t i = 0; i < start.size(); ++i) places.emplace(start.ids[i], start.positions[i]);
  std::vector<Eigen::Vector3d> moves;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const auto place = places.find(state.particles.ids[i]);
    if (place != places.end() && !is_lost(state.particles.positions[i].x()))
      moves.push_back(state.particles.positions[i] - place->second);
  }
  if (moves.empty()) return k_no_value;
  const Eigen::Vector3d common = mean_of(moves);
  double largest = 0.0;
  for (const auto& move : moves) largest = std::max(largest, (move - common).norm());
  return largest;
}

}  // namespace

Water water_of(const Scene& scene, const State& state, const Particles& start) {
  const Present present(scene, time_of(scene, state));
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < state.particles.size(); ++i)
    if (present.is_free(state.particles, i)) positions.push_back(state.particles.positions[i]);
  Water water;
  water.distortion = distortion_of(state, start);
  water.low = water.high = water.rms = Eigen::Vector3d::Constant(k_no_value);
  if (positions.empty()) return water;
  water.low = water.high = positions.front();
  const Eigen::Vector3d centre = mean_of(positions);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const auto& x : positions) {
    water.low = water.low.cwiseMin(x);
    water.high = water.high.cwiseMax(x);
    squares += (x - centre).cwiseAbs2();
  }
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * scene.fluid.spacing_m);
  water.low -= half;
  water.high += half;
  water.rms = (squares / static_cast<double>(positions.size())).cwiseSqrt();
  fill_depths(scene, positions, water);
  return water;
}

}  // namespace squall::harness
