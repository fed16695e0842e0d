/* OpenCL only, for CPU devices: the blocks' lists of neighbours, found with density and used again by forces. A share
   of the rows owns as much of the memory as it has particles, and packs its lists from the start. A list that does not
   fit is left out: forces search again. Nothing is lost but time, however many neighbours there are. dfsph has memory
   of the same shape for weights of pairs (solve_blocks.h). */
#ifndef SQUALL_LISTS_H
#define SQUALL_LISTS_H

#ifdef __cplusplus

namespace squall {

/// Entries of list memory per particle. A block of 8 has about 75 neighbours at rest density, one of 4 about 60.
inline constexpr int list_entries(int lanes) { return lanes == 4 ? 32 : 16; }

}  // namespace squall

#else

#include "blocks.h"

#define SQUALL_LIST_ENTRIES (SQUALL_LANES == 4 ? 32 : 16)
#define SQUALL_NO_LIST (-1)

typedef struct {
  __global int *memory, *next; /* a list is its length, then sorted indices */
  int room;                    /* entries left */
  int share_end;
} NeighbourLists;

static inline void open_lists(__global int* memory, const Share* share, NeighbourLists* lists) {
  lists->memory = memory;
  lists->next = memory + SQUALL_LIST_ENTRIES * (size_t)share->begin;
  lists->room = SQUALL_LIST_ENTRIES * (share->end - share->begin);
  lists->share_end = share->end;
}

/* The longest list that the block may have. Keeps room for the lengths of the blocks to come, of which there are no
   more than particles. */
static inline int longest_list(const NeighbourLists* lists, const Block* block) {
  return lists->room - 1 - (lists->share_end - block->end);
}

static inline void add_list(NeighbourLists* lists, const Block* block, const int* list, int length) {
  if (length > longest_list(lists, block)) length = SQUALL_NO_LIST;
  *lists->next++ = length;
  --lists->room;
  if (length == SQUALL_NO_LIST) return;
  for (int k = 0; k < length; ++k) lists->next[k] = list[k];
  lists->next += length;
  lists->room -= length;
}

#endif
#endif
