#include "core/scene.h"

#include <algorithm>
#include <cmath>

namespace squall {

double Scene::fastest_start() const {
  double speed = 0.0;
  for (const Block& block : blocks) speed = std::max(speed, block.velocity_m_s.norm());
  for (const ParticleFile& particle_file : particle_files)
    for (const Eigen::Vector3d& velocity : particle_file.particles.velocities) speed = std::max(speed, velocity.norm());
  return speed;
}

double Scene::fluid_depth() const {
  if (blocks.empty()) return container_size().y();
  double top = blocks.front().max_m.y();
  for (const Block& block : blocks) top = std::max(top, block.max_m.y());
  return top - container.min_m.y();
}

double Scene::reached_speed() const {
  double reached = std::sqrt(gravity_m_s2.norm() * fluid_depth());
  if (reached == 0.0) reached = fastest_start();
  return reached == 0.0 ? 1.0 : reached;
}

double Scene::speed_of_sound() const {
  // Ten times the speed the water will reach keeps compression near 1 % (Monaghan 1994).
  return solver.speed_of_sound_m_s ? *solver.speed_of_sound_m_s : 10.0 * reached_speed();
}

}  // namespace squall
