#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace squall {

/// The first two of `positions` [m, container frame] that are one place in single precision, by index, the lower one
/// first; nothing if there are none. Particles in one place feel no pressure from each other, as a smoothing kernel
/// has no gradient there, and so never part.
std::optional<std::pair<std::size_t, std::size_t>> same_place(const std::vector<Eigen::Vector3d>& positions);

}  // namespace squall
