#pragma once

#include <cstdint>

#include "core/reference_passes.h"
#include "core/scene.h"

/// dfsph as docs/dfsph.md derives it, pass by pass. Each pass reads of neighbours what no particle writes in it.
namespace squall::reference {

/// When a solve stops.
struct SolveLimits {
  double tolerance = 1e-3;    ///< mean error, relative density
  int least = 1, most = 100;  ///< iterations
};

/// What solves took.
struct SolveCost {
  int density_iterations = 0, divergence_iterations = 0;
  int unconverged = 0;  ///< solves that ended at SolveLimits::most
};

/// Density, wall gradient and response of particle i to its own pressure.
template <class Scalar>
void prepare(const Params<Scalar>& p, const Walls<Scalar>& walls, SortedParticles<Scalar>& sorted, int i);

/// Relative rate of compression D_i [1/s] of the velocities as they are.
template <class Scalar>
Scalar compression_rate_of(const Params<Scalar>& p, const SortedParticles<Scalar>& sorted, int i);

/// Into next_v: velocity after gravity, drag, viscosity, smoothing and the impulses to start from.
template <class Scalar>
void predict(const Params<Scalar>& p, const Terms& terms, const Substep<Scalar>& substep,
             SortedParticles<Scalar>& sorted, int i);

/// Velocity of particle i after every particle's change of impulse.
template <class Scalar>
void push(const Params<Scalar>& p, SortedParticles<Scalar>& sorted, int i);

/// Iterates impulses and velocities until the mean error is within the tolerance. Velocities must hold the impulses as
/// they are. Returns the iterations, and counts one that was cut short.
template <class Scalar>
int solve(const Params<Scalar>& p, const Substep<Scalar>& substep, const SolveLimits& limits,
          SortedParticles<Scalar>& sorted, SolveCost& cost);

/// A sub-step up to the drift: positions stay, velocities become those that keep the water's density.
template <class Scalar>
void make_incompressible(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls,
                         const Substep<Scalar>& substep, const Scene::Solver& settings, SortedParticles<Scalar>& sorted,
                         SolveCost& cost);

}  // namespace squall::reference
