#pragma once

#include <Eigen/Core>

#include <limits>

#include "core/particles.h"
#include "core/scene.h"

namespace squall::harness {

/// A number that is none: what a length has where there is no particle to measure.
inline constexpr double k_no_value = std::numeric_limits<double>::quiet_NaN();

/// What a state is as water, relative to the container's min corner and in its frame (docs/results.md). Lost particles
/// count nowhere; held ones count in mass and energy, but neither as front nor as height. Lengths without any particle
/// to measure are NaN; energies are sums, 0 without particles.
struct Observation {
  double time_s = 0.0;
  double front_m = k_no_value;      ///< 97th percentile of x in the lowest 2 dx, plus dx/2
  double front_max_m = k_no_value;  ///< largest x, plus dx/2
  double height_m = k_no_value;     ///< highest particle that has a neighbour, within H of x = 0, plus dx/2
  Eigen::Vector3d centre_m = Eigen::Vector3d::Constant(k_no_value);  ///< centre of mass
  double kinetic_j = 0.0;                                            ///< of the delivered (half-step) velocities
  double potential_j = 0.0;                                          ///< -m g.x, zero at the min corner
};

/// Observes the state at `time_s` seconds from the start.
Observation observe(const Scene& scene, const Particles& particles, double time_s);

/// Kinetic plus potential energy [J] of the particles with first_id <= id, lost ones left out.
double total_energy(const Scene& scene, const Particles& particles, std::uint32_t first_id = 0);

/// Every coordinate and velocity is a finite number.
bool is_finite(const Particles& particles);

}  // namespace squall::harness
