#include "harness/results_csv.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>
#include <vector>

#include "core/frame_plan.h"
#include "core/state_hash.h"
#include "grid.h"

namespace squall::harness {

void write_frames_header(std::ostream& out) {
  out << "run,frame,time_s,steps,dt_s,particles,frame_ms,compute_ms,readback_ms,upload_ms,readback_bytes_per_frame,"
         "readback_copied_bytes_per_frame,readback_latency_frames,iterations_mean,"
         "density_iterations,density_iterations_max,divergence_iterations,divergence_iterations_max,unconverged,"
         "light_passes,light_passes_ms,neighbours_mean,density_error_mean,"
         "density_error_max,max_speed_m_s,clamps,lost_particles,"
         "state_hash\n";
}

void write_frame(std::ostream& out, const std::string& run, const FrameRecord& frame) {
  const FrameReport& r = frame.report;
  fmt::print(out, "\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", run,
             r.frame, frame.time_s, r.substeps, r.dt_s, r.particles, r.frame_ms, r.compute_ms, r.readback_ms,
             r.upload_ms, r.readback_bytes, r.readback_copied_bytes, r.readback_latency_frames, r.iterations_mean,
             r.density_iterations, r.density_iterations_max, r.divergence_iterations, r.divergence_iterations_max,
             r.unconverged, r.light_passes, r.light_passes_ms, r.neighbours_mean, r.density_error_mean,
             r.density_error_max, r.max_speed, r.clamps, r.lost, hash_text(frame.state_hash));
}

void write_series_header(std::ostream& out) {
  out << "time_s,front_m,front_max_m,height_m,x_cm_m,y_cm_m,z_cm_m,kinetic_j,potential_j\n";
}

void write_observation(std::ostream& out, const Observation& o) {
  fmt::print(out, "{}", o.time_s);
  for (const double value : {o.front_m, o.front_max_m, o.height_m, o.centre_m.x(), o.centre_m.y(), o.centre_m.z(),
                             o.kinetic_j, o.potential_j})
    std::isnan(value) ? fmt::print(out, ",") : fmt::print(out, ",{}", value);
  out << "\n";
}

void write_particles(std::ostream& out, const Scene& scene, const State& state) {
  const double time_s = static_cast<double>(state.clock.frame) / scene.time.frame_rate_hz;
  const Eigen::Vector3d corner = scene.container.min_m + container_displacement(scene, time_s);
  const Eigen::Vector3d drift = container_velocity(scene, std::max(0.0, time_s - 0.5 * state.clock.previous_dt));
  const Particles& particles = state.particles;
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return particles.ids[a] < particles.ids[b]; });
  out << "id,x,y,z,vx,vy,vz\n";
  for (const std::size_t i : order) {
    if (is_lost(particles.positions[i].x())) continue;
    const Eigen::Vector3d x = corner + particles.positions[i], v = drift + particles.velocities[i];
    fmt::print(out, "{},{},{},{},{},{},{}\n", particles.ids[i], x.x(), x.y(), x.z(), v.x(), v.y(), v.z());
  }
}

}  // namespace squall::harness
