/* The sort for devices with many processors: a work-item per particle, no order between work-items, no barrier.

   A bin is a cell. Held and lost particles, of which there may be any number, have a bin for every SQUALL_BIN_BLOCK
   consecutive old indices, the held ones' behind the cells and the lost ones' behind those; so these bins are small,
   and in the order of the old indices. Within a bin a particle goes behind the members with a smaller old index: that
   is the stable order, whoever came first.

   Where bins start is a prefix sum in two levels: a tile is SQUALL_SORT_FAN bins, a group as many tiles. There are
   whole groups, and at least one bin more than are in use. */
#ifndef SQUALL_SORT_BINS_H
#define SQUALL_SORT_BINS_H

#define SQUALL_BIN_BLOCK 64
#define SQUALL_SORT_FAN 64

#ifdef __cplusplus

#include <cstddef>

namespace squall {

inline constexpr std::size_t k_sort_fan = SQUALL_SORT_FAN;

/// Bins for held, or for lost particles, where there is room for `capacity` in all.
inline constexpr std::size_t bin_blocks(std::size_t capacity) {
  return (capacity + SQUALL_BIN_BLOCK - 1) / SQUALL_BIN_BLOCK;
}

/// All bins.
inline constexpr std::size_t bin_count(std::size_t cells, std::size_t capacity) {
  constexpr std::size_t k_group = k_sort_fan * k_sort_fan;
  return (cells + 2 * bin_blocks(capacity) + k_group) / k_group * k_group;
}

}  // namespace squall

#else

#include "sort_key.h"

/* Bin of a particle with this key (sort_key.h) and old index. */
static inline int bin_of(__constant Params* p, int key, int i, int blocks) {
  if (key < p->cell_count) return key;
  return p->cell_count + (key - p->cell_count) * blocks + i / SQUALL_BIN_BLOCK;
}

#endif
#endif
