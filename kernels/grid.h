/* The cell grid and the canonical order (docs/determinism.md).

   Cells are H(1 + margin) long in y and z and a k_x_fineness-th of that in x; x runs fastest. The margin covers the
   rounding of coordinate * inverse_edge, so that two particles within H are never further apart than one cell in y and
   z and k_x_fineness cells in x. Coordinates outside the grid fall into its outermost cells: clamping moves two
   indices never further apart. Two cells follow the grid: one of held particles, one of lost ones. */
#ifndef SQUALL_GRID_H
#define SQUALL_GRID_H

#include "params.h"

#define SQUALL_X_FINENESS 2

SQUALL_NAMESPACE_BEGIN

#ifdef __cplusplus
inline constexpr int k_x_fineness = SQUALL_X_FINENESS;
#endif

SQUALL_SCALAR_FORMULA int cell_coordinate(Scalar coordinate, Scalar inverse_edge, int cells) {
  int cell = (int)(coordinate * inverse_edge);
  cell = cell < 0 ? 0 : cell;
  return cell < cells ? cell : cells - 1;
}

/* Cell of a position that is finite and not lost. */
SQUALL_SCALAR_FORMULA int cell_of(SQUALL_CONSTANT SQUALL_REF(Params) * p, Scalar x, Scalar y, Scalar z) {
  int cx = cell_coordinate(x, p->inverse_edge_x, p->cells_x);
  int cy = cell_coordinate(y, p->inverse_edge_yz, p->cells_y);
  int cz = cell_coordinate(z, p->inverse_edge_yz, p->cells_z);
  return (cz * p->cells_y + cy) * p->cells_x + cx;
}

/* Lost particles are marked by their place. */
SQUALL_SCALAR_FORMULA int is_lost(Scalar x) { return x > (Scalar)(SQUALL_LOST_FROM); }

SQUALL_SCALAR_FORMULA int held_cell(SQUALL_CONSTANT SQUALL_REF(Params) * p) { return p->cell_count; }
SQUALL_SCALAR_FORMULA int lost_cell(SQUALL_CONSTANT SQUALL_REF(Params) * p) { return p->cell_count + 1; }

SQUALL_NAMESPACE_END

#endif
