#include "core/rain.h"

#include <algorithm>
#include <cmath>

#include "core/mix.h"

namespace squall {

namespace {

__extension__ typedef __int128 Wide;

constexpr double k_rate_unit = 1e6;  // rates are integers of 1e-6/s, so that drops are counted exactly

std::int64_t to_units(double per_second) { return std::llround(per_second * k_rate_unit); }

/// Uniform in [0, 1).
double uniform(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// First frame that starts at or after a time.
std::int64_t frame_at(const Scene& scene, double time_s) {
  const double frame = std::ceil(time_s * scene.time.frame_rate_hz - 1e-6);
  return frame < 9e15 ? static_cast<std::int64_t>(std::max(frame, 0.0)) : std::int64_t{9000000000000000};
}

/// How far into the frame before its release a drop is due, in (0, 1].
double due_fraction(std::int64_t number, std::int64_t rate, std::int64_t frame_rate) {
  const auto rest = static_cast<std::int64_t>(Wide{number} * frame_rate % rate);
  return rest == 0 ? 1.0 : static_cast<double>(rest) / static_cast<double>(rate);
}

/// Where drop `number` (from 1) starts: anywhere over the area, as high as makes the rain even along one frame's fall.
Eigen::Vector3d release_point(const Scene& scene, const Scene::Rain& rain, std::uint64_t seed, std::size_t index,
                              std::int64_t number) {
  const std::uint64_t key = mix64(mix64(seed + index) + static_cast<std::uint64_t>(number));
  const double across = uniform(key), along = uniform(mix64(key));
  const double fall = terminal_speed(rain.drop_diameter_mm) / scene.time.frame_rate_hz;
  const double above =
      fall * due_fraction(number, to_units(particles_per_second(scene, rain)), to_units(scene.time.frame_rate_hz));
  const Eigen::Vector2d area = rain.area_max_m - rain.area_min_m;
  const Eigen::Vector3d corner =
      Eigen::Vector3d{rain.area_min_m.x(), rain.height_m, rain.area_min_m.y()} - scene.container.min_m;
  return corner + Eigen::Vector3d{across * area.x(), above, along * area.y()};
}

}  // namespace

double terminal_speed(double drop_diameter_mm) { return 9.65 - 10.3 * std::exp(-0.6 * drop_diameter_mm); }

double particles_per_second(const Scene& scene, const Scene::Rain& rain) {
  if (rain.particles_per_s) return *rain.particles_per_s;
  const double area = (rain.area_max_m - rain.area_min_m).prod();
  return *rain.rate_mm_h * 1e-3 / 3600.0 * area / scene.particle_volume();
}

std::int64_t drops_due(const Scene& scene, const Scene::Rain& rain, std::uint64_t frame) {
  const std::int64_t first = frame_at(scene, rain.start_s);
  const std::int64_t last = std::min(static_cast<std::int64_t>(frame), frame_at(scene, rain.stop_s));
  if (last <= first) return 0;
  const Wide due =
      Wide{to_units(particles_per_second(scene, rain))} * (last - first) / to_units(scene.time.frame_rate_hz);
  return due < rain.max_particles ? static_cast<std::int64_t>(due) : rain.max_particles;
}

Particles release_drops(const Scene& scene, std::uint64_t seed, Clock& clock) {
  Particles drops;
  const double time = static_cast<double>(clock.frame) / scene.time.frame_rate_hz;
  for (std::size_t index = 0; index < scene.rains.size(); ++index) {
    const auto& rain = scene.rains[index];
    const std::int64_t due = drops_due(scene, rain, clock.frame);
    if (due <= clock.rained[index]) continue;
    // Blown by the wind at terminal speed; what is left of gravity there acts for half the previous sub-step.
    const double speed = terminal_speed(rain.drop_diameter_mm);
    const Eigen::Vector3d fall{0.0, -speed, 0.0};
    const Eigen::Vector3d acceleration =
        scene.gravity_m_s2 - (k_standard_gravity / speed) * fall -
        (clock.previous_dt > 0.0 ? Eigen::Vector3d((container_velocity(scene, time) -
                                                    container_velocity(scene, time - 0.5 * clock.previous_dt)) /
                                                   (0.5 * clock.previous_dt))
                                 : Eigen::Vector3d(Eigen::Vector3d::Zero()));
    const Eigen::Vector3d velocity =
        fall + rain.wind_m_s - container_velocity(scene, time) - acceleration * (0.5 * clock.previous_dt);
    while (clock.rained[index] < due)
      drops.add(clock.next_id++, release_point(scene, rain, seed, index, ++clock.rained[index]), velocity);
  }
  return drops;
}

}  // namespace squall
