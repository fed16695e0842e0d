/* OpenCL only: the cell a particle is sorted by; held and lost ones have cells of their own behind all others. */
#ifndef SQUALL_SORT_KEY_H
#define SQUALL_SORT_KEY_H

#include "grid.h"

static inline int sort_key(__constant Params* p, __constant HeldGroup* groups, int held_count, Scalar4 position,
                           uint id) {
  if (is_lost(position.x)) return lost_cell(p);
  for (int g = 0; g < held_count; ++g)
    if (id >= groups[g].first_id && id < groups[g].end_id) return held_cell(p);
  return cell_of(p, position.x, position.y, position.z);
}

#endif
