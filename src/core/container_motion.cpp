#include <algorithm>

#include "core/frame_plan.h"

namespace squall {

namespace {

/// Share of a minimum-jerk displacement covered at s = t/T in [0, 1]: zero velocity and acceleration at both ends.
double minimum_jerk(double s) { return s * s * s * (10.0 + s * (-15.0 + s * 6.0)); }
double minimum_jerk_rate(double s) { return s * s * (30.0 + s * (-60.0 + s * 30.0)); }

}  // namespace

Eigen::Vector3d container_velocity(const Scene& scene, double time_s) {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (const auto& motion : scene.container.motions) {
    const double elapsed = std::clamp(time_s - motion.start_s, 0.0, motion.duration_s);
    if (motion.displacement_m)
      velocity += *motion.displacement_m * (minimum_jerk_rate(elapsed / motion.duration_s) / motion.duration_s);
    else
      velocity += *motion.acceleration_m_s2 * elapsed;
  }
  return velocity;
}

Eigen::Vector3d container_displacement(const Scene& scene, double time_s) {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  for (const auto& motion : scene.container.motions) {
    const double since_start = std::max(time_s - motion.start_s, 0.0);
    const double elapsed = std::min(since_start, motion.duration_s);
    if (motion.displacement_m)
      displacement += *motion.displacement_m * minimum_jerk(elapsed / motion.duration_s);
    else
      displacement += *motion.acceleration_m_s2 * (elapsed * (since_start - 0.5 * elapsed));
  }
  return displacement;
}

}  // namespace squall
