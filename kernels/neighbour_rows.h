/* OpenCL only: the candidates of a particle, in canonical order: nine rows of cells in ascending (z, y), each one
   contiguous range of sorted indices. */
#ifndef SQUALL_NEIGHBOUR_ROWS_H
#define SQUALL_NEIGHBOUR_ROWS_H

#include "grid.h"

typedef struct {
  int first_x, last_x, first_y, last_y, first_z, last_z; /* cells, both ends included */
} Neighbourhood;

static inline Neighbourhood neighbourhood(__constant Params* p, Scalar x, Scalar y, Scalar z) {
  int cx = cell_coordinate(x, p->inverse_edge_x, p->cells_x);
  int cy = cell_coordinate(y, p->inverse_edge_yz, p->cells_y);
  int cz = cell_coordinate(z, p->inverse_edge_yz, p->cells_z);
  Neighbourhood cells;
  cells.first_x = max(cx - SQUALL_X_FINENESS, 0);
  cells.last_x = min(cx + SQUALL_X_FINENESS, p->cells_x - 1);
  cells.first_y = max(cy - 1, 0);
  cells.last_y = min(cy + 1, p->cells_y - 1);
  cells.first_z = max(cz - 1, 0);
  cells.last_z = min(cz + 1, p->cells_z - 1);
  return cells;
}

/* Sorted indices [x, y) of the row at (y, z). */
static inline int2 candidates(__constant Params* p, __global const int* cell_start, Neighbourhood cells, int y, int z) {
  int first_cell = (z * p->cells_y + y) * p->cells_x;
  return (int2)(cell_start[first_cell + cells.first_x], cell_start[first_cell + cells.last_x + 1]);
}

#endif
