#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace squall {

/// The first of `positions` [m, container frame] from index `from` on that is one place with another before it, in
/// single precision: that one's index, then its own; nothing if there is none. Particles in one place feel no pressure
/// from each other, as a smoothing kernel has no gradient there, and so never part.
std::optional<std::pair<std::size_t, std::size_t>> same_place(const std::vector<Eigen::Vector3d>& positions,
                                                              std::size_t from);

}  // namespace squall
