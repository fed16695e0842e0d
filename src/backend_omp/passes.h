#pragma once

#include <cstdint>

#include "backend_omp/neighbour_list.h"
#include "core/settings.h"
#include "params.h"

namespace squall::openmp {

/// A particle, 32 bytes, so that one cache line holds two and one load all that a neighbour needs.
struct alignas(32) Record {
  float x, y, z;        ///< m
  float pressure_term;  ///< what a neighbour needs of the pressure (reference_passes.h); dfsph: change of the impulse,
                        ///< and the pressure itself between sub-steps, when others leave it unused
  float vx, vy, vz;     ///< m/s
  float volume_term;    ///< what a neighbour needs of the volume; dfsph: the impulse to start from. Unused between
                        ///< sub-steps
};
static_assert(sizeof(Record) == 32);

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
struct SolveArrays {
  float *opening_x, *opening_y, *opening_z;  ///< gradient of the open share, 1/m
  float *response, *inverse_response;
  float* room;
  float *impulse, *projected;
  float *start_vx, *start_vy, *start_vz;  ///< velocity before the solves
};

/// What the passes of a sub-step read and write. Rows are rows of cells; a thread works on its own.
struct PassContext {
  const Params<float>* params;
  const Substep<float>* substep;
  const Box<float>* boxes;
  PassTerms terms;
  const int* cell_start;  ///< cell_count + 3
  Record* sorted;         ///< in canonical order
  const float* x;         ///< the coordinates of `sorted` once more, each in a row
  const float* y;
  const float* z;
  Record* next;       ///< where the state after the sub-step goes, same order
  int* next_keys;     ///< likewise: the key of each for the sort that follows
  float* density;     ///< relative, per sorted particle
  float* pressure;    ///< p/rho0 [m^2/s^2], per sorted particle; mueller only
  float* isolation;   ///< per sorted particle; with drag only
  SolveArrays solve;  ///< dfsph only
};

/// What a thread finds out about its rows.
struct PassResult {
  float max_speed2 = 0.0f;
  float max_acceleration2 = 0.0f;
  std::int64_t clamps = 0;
  std::int64_t lost = 0;
  std::int64_t neighbours = 0;
  double density_error_sum = 0.0;
  float density_error_max = 0.0f;
};

/// Sums over a thread's rows that decide how dfsph goes on (core/convergence.h).
struct SolveSums {
  std::int64_t error = 0;   ///< of the solve under way
  std::int64_t excess = 0;  ///< of density beyond rest density
};

/// The passes for one instruction set, over rows [first, end).
struct Passes {
  int lanes;  ///< particles per block
  /// Finds neighbours (into `list`, from its beginning) and computes density, pressure and the terms neighbours need.
  void (*density)(const PassContext&, int first_row, int end_row, NeighbourList& list);
  /// Accelerations from the same lists, then kick, drift and the safety net. Adds particles to `key_counts`.
  void (*forces)(const PassContext&, int first_row, int end_row, const NeighbourList& list, PassResult& result,
                 int* key_counts);
  /// Counts neighbours within H and sums density errors, from the same lists.
  void (*statistics)(const PassContext&, int first_row, int end_row, const NeighbourList& list, PassResult& result);

  /// dfsph, the passes of docs/dfsph.md. Prepare finds neighbours and their weights and does the first half iteration
  /// of the divergence solve; its velocities are those of `sorted`.
  void (*prepare)(const PassContext&, int first_row, int end_row, NeighbourList& list, SolveSums& sums);
  /// Impulses to try next, from velocities as they are. Returns the sum of errors.
  std::int64_t (*rate)(const PassContext&, int first_row, int end_row, const NeighbourList& list, float momentum);
  /// Velocities after what rate() changed of the impulses.
  void (*push)(const PassContext&, int first_row, int end_row, const NeighbourList& list);
  /// Writes records to `next`, where the density solve goes on, with velocities after gravity, drag, viscosity,
  /// smoothing and the impulses to start from. `correction` as in density_room.
  void (*predict)(const PassContext&, int first_row, int end_row, const NeighbourList& list, float correction);
  /// Moves the records of `next` where their velocities lead, and the safety net.
  void (*drift)(const PassContext&, int first_row, int end_row, PassResult& result, int* key_counts);
};

/// For an instruction set that is available.
const Passes& passes_for(Simd simd);

const Passes& scalar_passes();
const Passes& avx2_passes();
const Passes& avx512_passes();

}  // namespace squall::openmp
