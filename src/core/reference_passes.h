#pragma once

#include <cstdint>
#include <vector>

#include "boundary.h"
#include "grid.h"
#include "params.h"
#include "sph_formulas.h"
#include "walls.h"

#include "core/settings.h"

/// The passes of a sub-step, written to be read: one particle at a time, one candidate at a time, in canonical order.
/// What they compute is what every backend must compute, to the last bit where Scalar is float.
namespace squall::reference {

/// A particle between two sub-steps, and what a sub-step finds out about it.
template <class Scalar>
struct Particle {
  std::uint32_t id = 0;
  Scalar x[3] = {};             ///< m, relative to the container's min corner
  Scalar v[3] = {};             ///< m/s, half a sub-step behind
  Scalar density = 0;           ///< relative to rest density
  Scalar pressure = 0;          ///< p/rho0, m^2/s^2
  Scalar pressure_term = 0;     ///< what a neighbour needs of the pressure: wcsph p/rho^2, mueller p/(2 rho)
  Scalar volume_term = 0;       ///< what a neighbour needs of the volume: wcsph 1/rho, mueller 1/(2 rho)
  Scalar wall_share = 0;        ///< share of the support behind walls
  Scalar isolation = 0;         ///< 1: no neighbour and no wall within H
  Scalar acceleration[3] = {};  ///< m/s^2
  int neighbours = 0;           ///< within H, without self

  // dfsph only (dfsph_formulas.h); `pressure` then outlives the sub-step
  Scalar opening_gradient[3] = {};  ///< of the open share, 1/m
  Scalar descent[3] = {};           ///< dfsph: minus the gradient of the own density, 1/m
  Scalar response = 0;              ///< to its own pressure, 1/m^2
  Scalar inverse_response = 0;
  Scalar room = 0;       ///< what a sub-step may compress, relative density
  Scalar impulse = 0;    ///< m^2/s
  Scalar change = 0;     ///< of the impulse, by the last iteration
  Scalar projected = 0;  ///< impulse before extrapolation
  Scalar start_v[3] = {}, next_v[3] = {};
};

/// Particles in canonical order, and where each cell's particles start.
template <class Scalar>
struct SortedParticles {
  std::vector<Particle<Scalar>> particles;
  std::vector<int> cell_start;  ///< cell_count + 3 entries: cells, held, lost, end

  int active() const { return cell_start[cell_start.size() - 3]; }
  int lost() const { return cell_start[cell_start.size() - 1] - cell_start[cell_start.size() - 2]; }
};

/// The walls of a scene at one moment.
template <class Scalar>
struct Walls {
  const Box<Scalar>* boxes = nullptr;
  int box_count = 0;
};

/// What a scene names decides which terms there are.
struct Terms {
  Pressure pressure{};
  bool viscosity = false;
  bool drag = false;
  bool smoothing = false;  ///< dfsph: [solver] xsph
};

/// Stable: particles of a cell keep the order they had; held ones come after all cells, lost ones last.
template <class Scalar>
void sort(const Params<Scalar>& p, const std::vector<HeldGroup>& groups, int held_count,
          SortedParticles<Scalar>& sorted);

/// Calls visit(j) for every candidate of particle i: nine rows of cells in ascending (z, y), ascending index in each.
template <class Scalar, class Visit>
void for_each_candidate(const Params<Scalar>& p, const SortedParticles<Scalar>& sorted, int i, Visit visit) {
  const Particle<Scalar>& particle = sorted.particles[static_cast<std::size_t>(i)];
  const int cx = cell_coordinate(particle.x[0], p.inverse_edge_x, p.cells_x);
  const int cy = cell_coordinate(particle.x[1], p.inverse_edge_yz, p.cells_y);
  const int cz = cell_coordinate(particle.x[2], p.inverse_edge_yz, p.cells_z);
  const int first_x = cx - k_x_fineness < 0 ? 0 : cx - k_x_fineness;
  const int last_x = cx + k_x_fineness < p.cells_x ? cx + k_x_fineness : p.cells_x - 1;
  for (int z = cz - 1; z <= cz + 1; ++z) {
    for (int y = cy - 1; y <= cy + 1; ++y) {
      if (z < 0 || z >= p.cells_z || y < 0 || y >= p.cells_y) continue;
      const int row = (z * p.cells_y + y) * p.cells_x;
      const int begin = sorted.cell_start[static_cast<std::size_t>(row + first_x)];
      const int end = sorted.cell_start[static_cast<std::size_t>(row + last_x + 1)];
      for (int j = begin; j < end; ++j) visit(j);
    }
  }
}

/// Open share at a particle and its gradient, for the density's or the force's kernel.
template <class Scalar>
Scalar opening(const Params<Scalar>& p, int kernel_shape, bool for_density, const Walls<Scalar>& walls, const Scalar* x,
               Scalar* gradient);

/// Density, pressure and the terms neighbours need, of particle i.
template <class Scalar>
void density(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls, SortedParticles<Scalar>& sorted,
             int i);

/// Acceleration of particle i from pressure, viscosity and walls, without gravity and drag.
template <class Scalar>
void forces(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls, SortedParticles<Scalar>& sorted,
            int i);

/// Adds gravity and drag to a particle's acceleration.
template <class Scalar>
void add_external_acceleration(const Params<Scalar>& p, const Terms& terms, const Substep<Scalar>& substep,
                               Particle<Scalar>& particle);

/// Drift and the safety net; returns SQUALL_CLAMPED, SQUALL_LOST or 0.
template <class Scalar>
int drift(const Params<Scalar>& p, const Walls<Scalar>& walls, const Substep<Scalar>& substep,
          Particle<Scalar>& particle);

/// Kick, drift and the safety net; returns SQUALL_CLAMPED, SQUALL_LOST or 0.
template <class Scalar>
int integrate(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls, const Substep<Scalar>& substep,
              Particle<Scalar>& particle);

}  // namespace squall::reference
