#include "harness/stress/bench.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid.h"
#include "harness/measures.h"

namespace squall::harness {

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// splitmix64 (Steele, Lea, Flood 2014): the same on every machine, unlike the distributions of <random>.
double unit_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15ull);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return std::ldexp(static_cast<double>((z ^ (z >> 31)) >> 11), -53);
}

Eigen::Vector3d random_vector(std::uint64_t& state, double reach) {
  Eigen::Vector3d v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = reach * (2.0 * unit_random(state) - 1.0);
  return v;
}

}  // namespace

std::unique_ptr<Solver> StressBench::make(const Scene& scene, const Settings& settings) const {
  return make_(subject_.backend, scene, settings);
}

std::unique_ptr<Solver> StressBench::in_double(const Scene& scene) const {
  Settings settings;
  settings.pressure = pressure();
  settings.precision = Precision::double_precision;
  return make_("reference", scene, settings);
}

double StressBench::rounding(double count, double scale) const {
  const bool single = settings().precision == Precision::single_precision;
  const double epsilon = single ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
  return count * epsilon * scale;
}

Scene stress_tank(const Eigen::Vector3d& size) {
  Scene scene;
  scene.name = "stress";
  scene.time.duration_s = 10.0;
  scene.time.frame_rate_hz = 1000.0;
  scene.fluid.spacing_m = k_stress_spacing;
  scene.container.max_m = size;
  scene.container.open_top = true;
  return scene;
}

Scene stress_block(const Eigen::Vector3d& size, const Eigen::Vector3i& layers, const Eigen::Vector3d& low) {
  Scene scene = stress_tank(size);
  Scene::Block block;
  block.min_m = low;
  block.max_m = low + k_stress_spacing * layers.cast<double>();
  scene.blocks.push_back(block);
  return scene;
}

Scene stress_pool(const Eigen::Vector3i& layers) {
  Eigen::Vector3d size = k_stress_spacing * layers.cast<double>();
  size.y() += 4.0 * k_stress_spacing;
  return stress_block(size, layers);
}

Scene with_room_for(Scene scene, std::size_t count) {
  Particles seats;
  const Eigen::Vector3d size = scene.container_size();
  for (std::size_t i = 0; i < count; ++i)
    seats.add(static_cast<std::uint32_t>(i),
              scene.container.min_m + size * (0.25 + 0.5 * static_cast<double>(i) / static_cast<double>(count)),
              Eigen::Vector3d::Zero());
  scene.particle_files.push_back({"stress.csv", std::move(seats)});
  return scene;
}

Particles in_single(Particles particles) {
  for (auto& x : particles.positions)
    for (int axis = 0; axis < 3; ++axis) x[axis] = static_cast<double>(static_cast<float>(x[axis]));
  for (auto& v : particles.velocities)
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<double>(static_cast<float>(v[axis]));
  return particles;
}

Particles shaken_cube(int n, double spacing, const Eigen::Vector3d& corner, double jitter, double speed,
                      std::uint64_t seed) {
  Particles particles;
  std::uint32_t id = 0;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Eigen::Vector3d place = corner + spacing * Eigen::Vector3d(x, y, z);
        const Eigen::Vector3d shift = random_vector(seed, jitter);
        particles.add(id++, place + shift, random_vector(seed, speed));
      }
  return in_single(std::move(particles));
}

Course run_frames(Solver& solver, int frames) {
  Course course;
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport& report = solver.advance(Delivery::nothing);
    course.substeps += report.substeps;
    course.clamps += report.clamps;
    course.unconverged += report.unconverged;
    course.limited_frames += report.time_step_limited ? 1 : 0;
    course.max_speed = std::max(course.max_speed, report.max_speed);
    course.max_density_error = std::max(course.max_density_error, report.density_error_max);
  }
  const FrameReport& last = solver.report();
  course.lost = last.lost;
  course.active = last.active;
  course.last_density_error = last.density_error_max;
  course.last_neighbours = last.neighbours_mean;
  return course;
}

Course run_seconds(Solver& solver, double seconds) {
  return run_frames(solver, std::max(1, static_cast<int>(std::lround(seconds * solver.scene().time.frame_rate_hz))));
}

double kinetic_j(const Scene& scene, const Particles& particles) {
  double sum = 0.0;
  for (const auto& v : particles.velocities) sum += v.squaredNorm();
  return 0.5 * scene.particle_mass() * sum;
}

double rms_speed(const Particles& particles) {
  double sum = 0.0;
  for (const auto& v : particles.velocities) sum += v.squaredNorm();
  return particles.size() == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(particles.size()));
}

std::vector<Eigen::Vector3d> positions_by_id(const Particles& particles, std::size_t count) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> result(count, Eigen::Vector3d::Constant(missing));
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles.ids[i] < count) result[particles.ids[i]] = particles.positions[i];
  return result;
}

double largest_distance(const Particles& a, const Particles& b) {
  if (a.size() != b.size()) return k_infinity;
  std::uint32_t largest_id = 0;
  for (const auto id : a.ids) largest_id = std::max(largest_id, id);
  const auto other = positions_by_id(b, std::size_t{largest_id} + 1);
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double distance = (a.positions[i] - other[a.ids[i]]).norm();
    largest = std::isfinite(distance) ? std::max(largest, distance) : k_infinity;
  }
  return largest;
}

bool same_bits(const Particles& a, const Particles& b) {
  return a.ids == b.ids && a.positions == b.positions && a.velocities == b.velocities && a.pressures == b.pressures;
}

std::vector<double> nearest_distances(const Particles& particles) {
  std::vector<double> nearest(particles.size(), k_infinity);
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t j = i + 1; j < particles.size(); ++j) {
      const double distance = (particles.positions[i] - particles.positions[j]).norm();
      nearest[i] = std::min(nearest[i], distance);
      nearest[j] = std::min(nearest[j], distance);
    }
  return nearest;
}

double furthest_outside(const Scene& scene, const Particles& particles) {
  const Eigen::Vector3d size = scene.container_size();
  double furthest = -k_infinity;
  for (const auto& x : particles.positions)
    for (int axis = 0; axis < 3; ++axis) {
      furthest = std::max(furthest, -x[axis]);
      if (axis != 1 || !scene.container.open_top) furthest = std::max(furthest, x[axis] - size[axis]);
    }
  return furthest;
}

void expect_sound(const Solver& solver, const Particles& now, StressOutcome& outcome) {
  std::size_t broken = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    broken += now.positions[i].allFinite() && now.velocities[i].allFinite() ? 0 : 1;
  outcome.equal("particles not finite", static_cast<double>(broken), 0.0);
  outcome.equal("particles lost", static_cast<double>(solver.report().lost), 0.0);
}

}  // namespace squall::harness
