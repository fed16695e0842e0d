#include <algorithm>
#include <cmath>

#include "harness/measures.h"
#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

const Eigen::Vector3d k_tank{0.8, 0.6, 0.4};
constexpr double k_clamp = 0.01 * k_stress_spacing;  ///< how far inside its plane a wall puts a particle

/// Mean number of others within H, by testing every pair.
double brute_force_neighbours(const Scene& scene, const Particles& particles) {
  const double reach = scene.support_radius();
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t j = i + 1; j < particles.size(); ++j)
      pairs += (particles.positions[i] - particles.positions[j]).squaredNorm() < reach * reach ? 1 : 0;
  return 2.0 * static_cast<double>(pairs) / static_cast<double>(particles.size());
}

}  // namespace

/// On planes, edges and corners and 1e-7 m inside of them, at rest.
void corner_residents(Bench bench, Outcome outcome) {
  Particles residents;
  for (int place = 0; place < 27; ++place) {
    const double d = place % 2 ? 1e-7 : 0.0;
    const Eigen::Vector3i index(place % 3, place / 3 % 3, place / 9);
    const Eigen::Vector3d share = index.cast<double>() / 2.0;
    const Eigen::Vector3d low = Eigen::Vector3d::Constant(d), high = k_tank - low;
    residents.add(static_cast<std::uint32_t>(place), low + share.cwiseProduct(high - low), Eigen::Vector3d::Zero());
  }
  const Scene scene = with_room_for(stress_tank(k_tank), residents.size());
  const auto solver = bench.make(scene);
  solver->load(in_single(residents));
  const Course course = run_frames(*solver, 1);
  const Particles now = solver->state().particles;
  expect_sound(*solver, now, outcome);
  outcome.at_most("fastest after a millisecond [m/s]", course.max_speed,
                  std::sqrt(2.0 * k_stress_gravity * k_stress_spacing));
  outcome.at_most("furthest outside [m]", furthest_outside(scene, now), bench.rounding(4.0, 1.0) - k_clamp);
}

/// A tenth of a spacing, a spacing and half a metre outside come back in and do not fly off; 100 m are lost and
/// counted.
void outsiders(Bench bench, Outcome outcome) {
  Particles outside;
  std::uint32_t id = 0;
  for (const double out : {0.005, 0.05, 0.5}) {
    outside.add(id++, {-out, 0.3 + 0.2 * out, 0.2}, {-1.0, 0.0, 0.0});
    outside.add(id++, {0.8 + out, 0.3 + 0.2 * out, 0.2}, {1.0, 0.0, 0.0});
    outside.add(id++, {0.2 + 0.5 * out, -out, 0.2}, {0.0, -1.0, 0.0});
    outside.add(id++, {0.4 + 0.5 * out, 0.1, 0.4 + out}, {0.0, 0.0, 1.0});
  }
  outside.add(id++, {100.0, 0.3, 0.2}, Eigen::Vector3d::Zero());
  const Scene scene = with_room_for(stress_tank(k_tank), outside.size());
  const auto solver = bench.make(scene);
  solver->load(in_single(outside));
  const Course course = run_frames(*solver, 5);
  Particles now = solver->state().particles;
  outcome.equal("particles lost: the one 100 m away", static_cast<double>(course.lost), 1.0);
  outcome.equal("particles accounted for", static_cast<double>(now.size()), static_cast<double>(outside.size()));
  outcome.at_least("times put back behind a wall", static_cast<double>(course.clamps), 12.0);
  now.ids.pop_back();
  now.positions.pop_back();
  now.velocities.pop_back();
  outcome.at_most("furthest outside [m]", furthest_outside(scene, now), bench.rounding(4.0, 1.0) - k_clamp);
  outcome.at_most("fastest particle [m/s]", course.max_speed,
                  1.0 + std::sqrt(2.0 * k_stress_gravity * scene.container_size().y()));
}

/// Water in and above gaps of one spacing and of half a one, and a container narrower than a kernel.
void thin_gaps(Bench bench, Outcome outcome) {
  for (const double gap : {1.0, 0.5}) {
    Scene scene = stress_block({0.8, 0.6, 0.4}, {10, 4, 8}, {(gap + 2.0) * k_stress_spacing, 0.0, 0.0});
    scene.boxes.push_back({{gap * k_stress_spacing, 0.0, 0.0}, {(gap + 2.0) * k_stress_spacing, 0.3, 0.4}, {}});
    if (gap >= 1.0) {
      Scene::Block between;
      between.max_m = {k_stress_spacing, 0.2, 0.4};
      between.min_m.setZero();
      scene.blocks.push_back(between);
    }
    const auto solver = bench.make(scene);
    const Course course = run_seconds(*solver, 0.3);
    expect_sound(*solver, solver->state().particles, outcome);
    // the front of a dam break over a dry bed, the fastest this depth of water makes (Ritter 1892)
    outcome.at_most(gap >= 1.0 ? "gap of dx: fastest particle [m/s]" : "gap of dx/2: fastest particle [m/s]",
                    course.max_speed, 2.0 * std::sqrt(k_stress_gravity * 0.2));
  }
  const Scene narrow = stress_pool({1, 4, 1});  // walls on both sides within reach of every particle
  const auto solver = bench.make(narrow);
  const Course course = run_seconds(*solver, 0.3);
  expect_sound(*solver, solver->state().particles, outcome);
  outcome.at_most("container of dx: fastest particle [m/s]", course.max_speed, 2.0 * std::sqrt(k_stress_gravity * 0.2));
}

/// First and last cells of the grid, with the container at negative coordinates and particles above its rim.
void edges_of_the_grid(Bench bench, Outcome outcome) {
  Scene scene = stress_tank(k_tank);
  scene.container.min_m = {-0.73, -0.41, -0.17};
  scene.container.max_m = scene.container.min_m + k_tank;
  Particles cloud = shaken_cube(11, 0.072, {0.0, 0.0, 0.0}, 0.03, 0.0, 11);
  Particles inside;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3d x = cloud.positions[i].cwiseMax(k_clamp);
    x.x() = std::min(x.x(), k_tank.x() - k_clamp);
    x.z() = std::min(x.z(), k_tank.z() - k_clamp);
    inside.add(static_cast<std::uint32_t>(i), x, Eigen::Vector3d::Zero());
  }
  inside = in_single(inside);
  scene = with_room_for(scene, inside.size());
  scene.solver.speed_of_sound_m_s = 10.0;  // one sub-step in a frame: neighbours are those of the start
  scene.solver.max_iterations = 3;
  const auto solver = bench.make(scene);
  solver->load(inside);
  const Course course = run_frames(*solver, 1);
  outcome.equal("sub-steps of the frame", static_cast<double>(course.substeps), 1.0);
  outcome.equal("neighbours, mean, as by brute force", course.last_neighbours, brute_force_neighbours(scene, inside));
}

/// The same water a kilometre away is the same water.
void far_from_the_origin(Bench bench, Outcome outcome) {
  Particles end[2];
  for (const bool away : {false, true}) {
    Scene scene = stress_block({0.8, 0.6, 0.4}, {6, 6, 8});
    scene.time.frame_rate_hz = 100.0;
    if (away) {
      const Eigen::Vector3d shift(999.0, -1000.0, 998.0);
      scene.container.min_m += shift;
      scene.container.max_m += shift;
      scene.blocks[0].min_m += shift;
      scene.blocks[0].max_m += shift;
    }
    const auto solver = bench.make(scene);
    run_seconds(*solver, 0.2);
    end[away ? 1 : 0] = solver->state().particles;
  }
  outcome.at_most("distance from the water at the origin [dx]", largest_distance(end[0], end[1]) / k_stress_spacing,
                  1e-5);
}

/// The container around water under pressure vanishes: from then on it falls, and nothing bursts it apart.
void vanishing_walls(Bench bench, Outcome outcome) {
  const double wall = 2.0 * k_stress_spacing, side = 0.5;
  const Eigen::Vector3d low(0.5, 1.0, 0.5), high = low + Eigen::Vector3d::Constant(side);
  Scene scene = stress_tank({1.5, 2.0, 1.5});
  const double until = 0.3;
  const auto box = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    scene.boxes.push_back({from, to, until});
  };
  const Eigen::Vector3d out = Eigen::Vector3d::Constant(wall);
  box(low - out, {high.x() + wall, low.y(), high.z() + wall});
  box({low.x() - wall, low.y(), low.z()}, {low.x(), high.y() + wall, high.z()});
  box({high.x(), low.y(), low.z()}, {high.x() + wall, high.y() + wall, high.z()});
  box({low.x() - wall, low.y(), low.z() - wall}, {high.x() + wall, high.y() + wall, low.z()});
  box({low.x() - wall, low.y(), high.z()}, {high.x() + wall, high.y() + wall, high.z() + wall});
  Scene::Block block;
  block.min_m = low;
  block.max_m = {high.x(), high.y() - 0.1, high.z()};
  scene.blocks.push_back(block);
  const auto solver = bench.make(scene);
  run_seconds(*solver, until);
  const Particles before = solver->state().particles;
  run_frames(*solver, 1);
  run_frames(*solver, 1);
  const Particles after = solver->state().particles;
  expect_sound(*solver, after, outcome);
  const auto speeds = [](const Particles& particles) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& v : particles.velocities) mean += v / static_cast<double>(particles.size());
    return mean;
  };
  const double dt = 2.0 / scene.time.frame_rate_hz;
  const Eigen::Vector3d mean = (speeds(after) - speeds(before)) / dt;
  outcome.at_most("acceleration of all, off gravity [g]", (mean - scene.gravity_m_s2).norm() / k_stress_gravity, 0.1);
  const double reach = scene.support_radius();
  std::vector<Eigen::Vector3d> velocities(before.size());
  std::vector<bool> inner(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector3d& x = before.positions[i];
    velocities[before.ids[i]] = before.velocities[i];
    inner[before.ids[i]] = ((x - block.min_m).array() > reach).all() && ((block.max_m - x).array() > reach).all();
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!inner[after.ids[i]]) continue;
    const Eigen::Vector3d acceleration = (after.velocities[i] - velocities[after.ids[i]]) / dt;
    worst = std::max(worst, (acceleration - scene.gravity_m_s2).norm());
  }
  outcome.at_most("acceleration of one inside, off gravity [g]", worst / k_stress_gravity, 0.1);
}

}  // namespace squall::harness::stress
