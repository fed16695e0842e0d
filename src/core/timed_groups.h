#pragma once

#include <cstddef>
#include <vector>

#include "core/scene.h"

/// Boxes and held blocks in the order that the sub-step table counts them: what lasts longest comes first.
namespace squall {

/// Indices into scene.boxes.
std::vector<std::size_t> boxes_by_end(const Scene& scene);
/// When each box vanishes [s], infinity for never, in that order.
std::vector<double> box_ends(const Scene& scene);
/// When each held group is released [s], in the order of make_held_groups().
std::vector<double> held_ends(const Scene& scene);

}  // namespace squall
