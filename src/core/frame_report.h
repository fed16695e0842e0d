#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/phase_span.h"

namespace squall {

/// What one frame was and cost. Times are wall clock [ms].
struct FrameReport {
  std::uint64_t frame = 0;  ///< index, from 0
  int substeps = 0;
  double dt_s = 0.0;
  std::int64_t density_iterations = 0;     ///< of dfsph, all sub-steps together; 0 for solvers without
  std::int64_t divergence_iterations = 0;  ///< likewise
  int density_iterations_max = 0;          ///< of one sub-step
  int divergence_iterations_max = 0;       ///< likewise
  int unconverged = 0;                     ///< solves of dfsph that max_iterations cut short
  std::int64_t light_passes = 0;           ///< of dfsph over particles and neighbours, beside one heavy per sub-step
  double light_passes_ms = 0.0;            ///< wall clock of them; 0 where a backend does not time them
  double iterations_mean = 0.0;            ///< both kinds, per sub-step
  double smoothing_viscosity = 0.0;        ///< m^2/s: what [solver] xsph amounts to
  double frame_ms = 0.0;     ///< from the call of advance until the data asked for can be read, queues finished
  double upload_ms = 0.0;    ///< plan and appended particles to the device
  double readback_ms = 0.0;  ///< from compute complete to data readable; 0 if it was readable before
  double compute_ms = 0.0;   ///< frame - readback - upload
  std::map<std::string, double> phase_ms;  ///< with Settings::profile: sort, density, forces, ...; else empty

  std::uint64_t readback_bytes = 0;         ///< of the positions delivered: 12 for each, 6 in 16 bits
  std::uint64_t readback_copied_bytes = 0;  ///< written to deliver them, by kernels and by transfers; 0: zero copy
  int readback_latency_frames = 0;          ///< the positions delivered are of so many frames ago
  double readback_copy_ms = 0.0;  ///< with Settings::profile: device time of what readback_copied_bytes counts, of maps
  double readback_hidden_ms = 0.0;  ///< with Settings::profile: the part of it beside other commands of the frame

  std::int64_t particles = 0;      ///< all there are, lost ones included
  std::int64_t active = 0;         ///< neither held nor lost, in the last sub-step
  std::int64_t lost = 0;           ///< so far: not finite, or further away than ten container heights
  std::int64_t clamps = 0;         ///< times a particle was put back behind a wall in this frame
  double max_speed = 0.0;          ///< m/s, over the frame
  double max_acceleration = 0.0;   ///< m/s^2, over the frame
  bool time_step_limited = false;  ///< k_max_substeps left a step too long for the speeds that were met

  double density_error_mean = 0.0;  ///< mean of max(rho/rho0 - 1, 0) over active particles, last sub-step
  double density_error_max = 0.0;
  double neighbours_mean = 0.0;                                      ///< within H, without self, last sub-step
  Eigen::Vector3d container_displacement = Eigen::Vector3d::Zero();  ///< m, at the end of the frame

  std::vector<PhaseSpan> spans;  ///< with Settings::trace: what was done when; else empty
  double clock_error_ms = 0.0;   ///< spans of a device may lie off those of the host by as much as this
};

}  // namespace squall
