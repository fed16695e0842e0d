#pragma once

#include <cstdint>

#include "backend_omp/neighbour_list.h"
#include "core/settings.h"
#include "params.h"

namespace squall::openmp {

/// A particle: all that a neighbour needs in one cache line, which holds two of them in single precision.
template <class Scalar>
struct alignas(8 * sizeof(Scalar)) Record {
  Scalar x, y, z;        ///< m
  Scalar pressure_term;  ///< what a neighbour needs of the pressure (reference_passes.h); dfsph: change of the impulse,
                         ///< and the pressure itself between sub-steps, when others leave it unused
  Scalar vx, vy, vz;     ///< m/s
  Scalar volume_term;    ///< what a neighbour needs of the volume; dfsph: the impulse to start from. Unused between
                         ///< sub-steps
};
static_assert(sizeof(Record<float>) == 32 && sizeof(Record<double>) == 64);

/// Indices [begin, end).
struct Range {
  int begin, end;
};

/// Records behind the last one, far away, so that a block may load lanes it does not have.
inline constexpr int k_padding = 64;

/// Which terms the scene names.
struct PassTerms {
  Pressure pressure;
  bool viscosity;
  bool drag;
  bool smoothing;  ///< dfsph: [solver] xsph
};

/// What dfsph keeps of each sorted particle during a sub-step (dfsph_formulas.h).
template <class Scalar>
struct SolveArrays {
  Scalar *descent_x, *descent_y, *descent_z;  ///< minus the gradient of a particle's own density, 1/m
  Scalar *response, *inverse_response;
  Scalar* room;
  Scalar *impulse, *projected;
  Scalar *start_vx, *start_vy, *start_vz;  ///< velocity before the solves
};

/// What the passes of a sub-step read and write. Rows are rows of cells; a thread works on its own.
template <class Scalar>
struct PassContext {
  const Params<Scalar>* params;
  const Substep<Scalar>* substep;
  const Box<Scalar>* boxes;
  PassTerms terms;
  const int* cell_start;   ///< cell_count + 3
  Record<Scalar>* sorted;  ///< in canonical order
  const Scalar* x;         ///< the coordinates of `sorted` once more, each in a row
  const Scalar* y;
  const Scalar* z;
  Record<Scalar>* next;       ///< where the state after the sub-step goes, same order
  int* next_keys;             ///< likewise: the key of each for the sort that follows
  Scalar* density;            ///< relative, per sorted particle
  Scalar* pressure;           ///< p/rho0 [m^2/s^2], per sorted particle; mueller only
  Scalar* isolation;          ///< per sorted particle; with drag only
  int* neighbours;            ///< within H, without self, per sorted particle; what statistics() counts
  SolveArrays<Scalar> solve;  ///< dfsph only
};

/// What a thread finds out about its rows.
template <class Scalar>
struct PassResult {
  Scalar max_speed2 = 0.0f;
  Scalar max_acceleration2 = 0.0f;
  std::int64_t clamps = 0;
  std::int64_t lost = 0;
  std::int64_t neighbours = 0;
  double density_error_sum = 0.0;
  Scalar density_error_max = 0.0f;
};

/// Sums over a thread's rows that decide how dfsph goes on (core/convergence.h).
struct SolveSums {
  std::int64_t error = 0;   ///< of the solve under way
  std::int64_t excess = 0;  ///< of density beyond rest density
};

/// The passes for one instruction set and precision, over rows [first, end).
template <class Scalar>
struct Passes {
  int lanes;  ///< particles per block
  /// Finds neighbours (into `list`, from its beginning) and computes density, pressure and the terms neighbours need.
  void (*density)(const PassContext<Scalar>&, int first_row, int end_row, NeighbourList<Scalar>& list);
  /// Accelerations from the same lists, then kick, drift and the safety net. Adds particles to `key_counts`.
  void (*forces)(const PassContext<Scalar>&, int first_row, int end_row, const NeighbourList<Scalar>& list,
                 PassResult<Scalar>& result, int* key_counts);
  /// Counts neighbours within H and sums density errors, from the same lists.
  void (*statistics)(const PassContext<Scalar>&, int first_row, int end_row, const NeighbourList<Scalar>& list,
                     PassResult<Scalar>& result);

  /// dfsph, the passes of docs/dfsph.md. Prepare finds neighbours and their weights and does the first half iteration
  /// of the divergence solve; its velocities are those of `sorted`.
  void (*prepare)(const PassContext<Scalar>&, int first_row, int end_row, NeighbourList<Scalar>& list, SolveSums& sums);
  /// Impulses to try next, from velocities as they are. Returns the sum of errors.
  std::int64_t (*rate)(const PassContext<Scalar>&, int first_row, int end_row, const NeighbourList<Scalar>& list,
                       Scalar momentum);
  /// Velocities after what rate() changed of the impulses.
  void (*push)(const PassContext<Scalar>&, int first_row, int end_row, const NeighbourList<Scalar>& list);
  /// Writes records to `next`, where the density solve goes on, with velocities after gravity, drag, viscosity,
  /// smoothing and the impulses to start from. `correction` as in density_room.
  void (*predict)(const PassContext<Scalar>&, int first_row, int end_row, const NeighbourList<Scalar>& list,
                  Scalar correction);
  /// Moves the records of `next` where their velocities lead, and the safety net.
  void (*drift)(const PassContext<Scalar>&, int first_row, int end_row, PassResult<Scalar>& result, int* key_counts);
};

/// For an instruction set that is available.
template <class Scalar>
const Passes<Scalar>& passes_for(Simd simd);

/// Each is defined where it is compiled, for its instruction set and precision.
template <class Scalar>
const Passes<Scalar>& scalar_passes();
template <class Scalar>
const Passes<Scalar>& avx2_passes();
template <class Scalar>
const Passes<Scalar>& avx512_passes();
template <>
const Passes<float>& scalar_passes();
template <>
const Passes<double>& scalar_passes();
template <>
const Passes<float>& avx2_passes();
template <>
const Passes<double>& avx2_passes();
template <>
const Passes<float>& avx512_passes();
template <>
const Passes<double>& avx512_passes();

}  // namespace squall::openmp
