#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <vector>

#include "harness/stress/stress.h"

namespace squall::harness {

/// What some frames of a run added up to.
struct Course {
  std::int64_t substeps = 0, clamps = 0, lost = 0, active = 0;
  std::int64_t limited_frames = 0;  ///< where k_max_substeps left the step too long
  std::int64_t unconverged = 0;     ///< solves of dfsph that were cut short
  double max_speed = 0.0;           ///< m/s
  double max_density_error = 0.0;
  double last_density_error = 0.0;  ///< its maximum after the last frame
  double last_neighbours = 0.0;
};

/// What a case works with: solvers of its subject, a reference in double, and bounds that follow from the precision.
class StressBench {
 public:
  StressBench(const StressFactory& make, const StressSubject& subject, bool quick)
      : make_(make), subject_(subject), quick_(quick) {}

  const Settings& settings() const { return subject_.settings; }
  Pressure pressure() const { return subject_.settings.pressure; }
  const std::string& backend() const { return subject_.backend; }
  bool quick() const { return quick_; }

  std::unique_ptr<Solver> make(const Scene& scene) const { return make(scene, settings()); }
  std::unique_ptr<Solver> make(const Scene& scene, const Settings& settings) const;
  /// The specification: backend reference in double, same pressure solver.
  std::unique_ptr<Solver> in_double(const Scene& scene) const;

  /// Error bound of `count` roundings of values up to `scale` in the subject's precision.
  double rounding(double count, double scale) const;

 private:
  const StressFactory& make_;
  const StressSubject& subject_;
  bool quick_;
};

inline constexpr double k_stress_spacing = 0.05;  ///< m, of every scene unless a case says otherwise
inline constexpr double k_stress_gravity = 9.81;  ///< m/s^2

/// An empty open container from the origin to `size` [m], a thousand frames a second.
Scene stress_tank(const Eigen::Vector3d& size);
/// The same with a block of water of `layers` particles along each axis in its low corner, from `low` on.
Scene stress_block(const Eigen::Vector3d& size, const Eigen::Vector3i& layers,
                   const Eigen::Vector3d& low = Eigen::Vector3d::Zero());
/// A closed-in tank that its water fills `layers` deep from wall to wall.
Scene stress_pool(const Eigen::Vector3i& layers);

/// A scene with room for these particles; the caller loads them (load_into), since they may lie where no scene file
/// may put them.
Scene with_room_for(Scene scene, std::size_t count);
/// Particles in single precision, so that every backend starts from the same.
Particles in_single(Particles particles);
/// A lattice of n^3 particles from `corner`, `spacing` apart, each shifted by up to `jitter` and with a velocity of up
/// to `speed` per component.
Particles shaken_cube(int n, double spacing, const Eigen::Vector3d& corner, double jitter, double speed,
                      std::uint64_t seed);

/// Advances by `frames`. `fastest` of the course is over all of them.
Course run_frames(Solver& solver, int frames);
Course run_seconds(Solver& solver, double seconds);

double kinetic_j(const Scene& scene, const Particles& particles);
double rms_speed(const Particles& particles);
/// Positions by id; NaN where an id is missing.
std::vector<Eigen::Vector3d> positions_by_id(const Particles& particles, std::size_t count);
/// Largest distance between particles of equal id [m]; infinite where a particle is missing or not finite.
double largest_distance(const Particles& a, const Particles& b);
/// The state's bits are the same, order included.
bool same_bits(const Particles& a, const Particles& b);
/// Smallest distance of each particle to another [m].
std::vector<double> nearest_distances(const Particles& particles);
/// Largest excursion out of the container, over all axes but the open top [m]; negative inside.
double furthest_outside(const Scene& scene, const Particles& particles);

/// What every case asks of every run: finite, nobody lost.
void expect_sound(const Solver& solver, const Particles& now, StressOutcome& outcome);

}  // namespace squall::harness
