#include "backend_omp/row_split.h"

namespace squall::openmp {

template <class Scalar>
Range split_rows(const int* cell_start, const Params<Scalar>& p, int lanes, int part, int parts) {
  const int rows = p.cells_y * p.cells_z;
  const auto blocks_in = [&](int row) {
    const int particles = cell_start[(row + 1) * p.cells_x] - cell_start[row * p.cells_x];
    return (particles + lanes - 1) / lanes;
  };
  std::int64_t blocks = 0;
  for (int row = 0; row < rows; ++row) blocks += blocks_in(row);

  // A share begins with the first row before which there are enough blocks.
  Range share{part == 0 ? 0 : rows, rows};
  std::int64_t before = 0;
  for (int row = 0; row < rows; ++row) {
    if (part > 0 && share.begin == rows && before >= blocks * part / parts) share.begin = row;
    if (part + 1 < parts && before >= blocks * (part + 1) / parts) {
      share.end = row;
      break;
    }
    before += blocks_in(row);
  }
  return share;
}

template Range split_rows(const int*, const Params<float>&, int, int, int);
template Range split_rows(const int*, const Params<double>&, int, int, int);

}  // namespace squall::openmp
