#pragma once

#include <cstdint>
#include <vector>

#include "core/particles.h"
#include "core/scene.h"
#include "core/settings.h"
#include "core/time_step.h"
#include "params.h"

namespace squall {

/// What one frame does, decided once by core for every backend: sub-steps of equal length and everything that depends
/// on time alone.
struct FramePlan {
  std::uint64_t frame = 0;                ///< index of the frame that is advanced, from 0
  double dt = 0.0;                        ///< s, of each sub-step
  bool limited = false;                   ///< the time step wanted was smaller than k_max_substeps allow
  std::vector<Substep<double>> substeps;  ///< at least one
};

/// What core carries from frame to frame, beside the particles; part of a checkpoint.
struct Clock {
  std::uint64_t frame = 0;           ///< frames completed
  int previous_substeps = 0;         ///< of the last frame; 0 at the start
  double previous_dt = 0.0;          ///< s, 0 at the start: the first kick is half
  double max_speed = 0.0;            ///< m/s, largest |v| the last frame left
  double max_acceleration = 0.0;     ///< m/s^2, largest |a| the last frame left
  std::uint32_t next_id = 0;         ///< of the next appended particle
  std::vector<std::int64_t> rained;  ///< drops released so far, per rain

  int substep = 0;                       ///< sub-steps done of the frame under way; 0 between frames
  double max_speed_so_far = 0.0;         ///< m/s, in those
  double max_acceleration_so_far = 0.0;  ///< m/s^2, in those
};

/// Plans the frame that follows `clock`. n sub-steps of equal dt = T/n from v_bound = v_max + T a_max
/// (docs/physics.md); n falls by at most 10 % (or one) per frame.
FramePlan plan_frame(const Scene& scene, const Settings& settings, const Clock& clock);

/// Velocity [m/s] and displacement [m] of the container at a time [s] from the start.
Eigen::Vector3d container_velocity(const Scene& scene, double time_s);
Eigen::Vector3d container_displacement(const Scene& scene, double time_s);

/// Boxes in container coordinates, those that stand longest first, and ids of held blocks, those held longest first: so
/// that a count in the sub-step table says which are left.
std::vector<Box<double>> make_boxes(const Scene& scene, Pressure pressure);
std::vector<HeldGroup> make_held_groups(const Scene& scene);

/// The constants of a run. Throws InputError if the grid would need more than k_max_cells cells.
Params<double> make_params(const Scene& scene, Pressure pressure);
inline constexpr std::int64_t k_max_cells = std::int64_t{1} << 26;

/// Rounds constants, boxes or sub-steps to single precision, once.
Params<float> to_single(const Params<double>& params);
Substep<float> to_single(const Substep<double>& substep);
Box<float> to_single(const Box<double>& box);

/// Lattice sum S = V0 sum W of a kernel (SQUALL_CUBIC, ...) at H/dx, self included (docs/physics.md).
double lattice_sum(int kernel_shape, double support_ratio);
/// How far outward, in spacings, a wall plane must lie for a lattice whose first layer is dx/2 off the face to have
/// rest density.
double wall_shift(int kernel_shape, double support_ratio);

}  // namespace squall
