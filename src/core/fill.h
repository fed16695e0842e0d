#pragma once

#include <cstdint>

#include "core/scene.h"

/// How blocks are filled; private to core.
namespace squall {

/// Particles that fit into a length [m] at a spacing [m]. A length that misses a whole number of spacings by rounding
/// only counts as whole: 0.4 / (0.4 / 18) is 18.
std::int64_t layers(double length, double spacing);

/// Particles of all blocks before boxes take some away, as a double because a careless spacing overflows integers.
double lattice_points(const Scene& scene);

/// Particles of one block, without those that boxes take away.
std::int64_t block_points(const Scene& scene, const Scene::Block& block);

/// Two blocks that share more than a face, as indices first < second; first == second if there are none.
struct BlockPair {
  std::size_t first = 0, second = 0;
};
BlockPair overlapping_blocks(const Scene& scene);

/// Lengths that differ by less than this are the same [m]: a millionth of the spacing.
double length_tolerance(const Scene& scene);

}  // namespace squall
