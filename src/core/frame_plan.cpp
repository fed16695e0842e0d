#include "core/frame_plan.h"

#include <algorithm>
#include <cmath>

#include "core/timed_groups.h"

namespace squall {

namespace {

/// How many of the ends (in falling order) lie after a time; an event within a millionth of a frame counts as reached.
int lasting(const std::vector<double>& ends, double time, double frame_length) {
  const auto reached = [&](double end) { return end <= time + 1e-6 * frame_length; };
  return static_cast<int>(std::find_if(ends.begin(), ends.end(), reached) - ends.begin());
}

/// Gravity in the container's frame, averaged over [begin, end], so that no impulse of the container is lost.
Eigen::Vector3d effective_gravity(const Scene& scene, double begin, double end) {
  const Eigen::Vector3d gained = container_velocity(scene, end) - container_velocity(scene, begin);
  return scene.gravity_m_s2 - gained / (end - begin);
}

/// Largest |gravity| felt during a frame, and the speed of blocks that may be released in it.
double largest_gravity(const Scene& scene, double begin, double length) {
  constexpr int k_samples = 16;
  double largest = 0.0;
  for (int i = 0; i < k_samples; ++i) {
    const double from = begin + length * i / k_samples;
    largest = std::max(largest, effective_gravity(scene, from, from + length / k_samples).norm());
  }
  return largest;
}

double largest_held_speed(const Scene& scene, double time) {
  double largest = 0.0;
  for (const auto& block : scene.blocks)
    if (block.held_until_s && *block.held_until_s >= time) largest = std::max(largest, block.velocity_m_s.norm());
  return largest;
}

int fixed_count(double length, double step) {
  return static_cast<int>(std::clamp(std::round(length / step), 1.0, static_cast<double>(k_max_substeps)));
}

/// Sub-steps of the frame; sets `limited` if more were wanted than there may be.
int substep_count(const Scene& scene, Pressure pressure, const Clock& clock, double begin, double length,
                  bool& limited) {
  const double speed = std::max(clock.max_speed, largest_held_speed(scene, begin));
  double acceleration = largest_gravity(scene, begin, length);
  // Impacts on water that cannot give way make accelerations that last a sub-step: they say nothing about a frame.
  if (pressure != Pressure::dfsph) acceleration = std::max(acceleration, clock.max_acceleration);
  const double wanted = substeps_needed(scene, pressure, speed + length * acceleration);
  limited = !(wanted <= k_max_substeps);
  const int needed = limited ? k_max_substeps : std::max(1, static_cast<int>(wanted));
  return std::max(needed, clock.previous_substeps - std::max(1, clock.previous_substeps / 10));
}

constexpr double k_relaxation = 0.5;  ///< of dfsph's Jacobi iterations (docs/dfsph.md)
constexpr double k_warm_start = 0.5;  ///< how much of the last pressure dfsph starts from (docs/dfsph.md)
constexpr double k_correction = 0.5;  ///< mean over-density that goes away while water falls through its own depth

/// What dfsph needs of a sub-step whose dt and kick are set. Where walls vanish, pressure starts from nothing.
void set_pressure_solve(const Scene& scene, bool walls_vanish, Substep<double>& substep) {
  substep.warm_kick = walls_vanish ? 0.0 : k_warm_start * substep.kick;
  substep.inverse_kick = 1.0 / substep.kick;
  substep.relaxation_rate = k_relaxation / substep.dt;
  substep.correction = k_correction * scene.reached_speed() / scene.fluid_depth() * substep.dt;
}

}  // namespace

FramePlan plan_frame(const Scene& scene, const Settings& settings, const Clock& clock) {
  FramePlan plan;
  const double length = 1.0 / scene.time.frame_rate_hz;
  const double begin = static_cast<double>(clock.frame) / scene.time.frame_rate_hz;
  const int count = settings.fixed_step_s > 0.0
                        ? fixed_count(length, settings.fixed_step_s)
                        : substep_count(scene, settings.pressure, clock, begin, length, plan.limited);
  plan.frame = clock.frame;
  plan.dt = length / count;

  const std::vector<double> boxes_end = box_ends(scene), groups_end = held_ends(scene);
  double previous_dt = clock.previous_dt;
  int held_before = lasting(groups_end, begin - previous_dt, length);
  int boxes_before = lasting(boxes_end, begin - previous_dt, length);
  for (int s = 0; s < count; ++s) {
    const double time = begin + plan.dt * s;
    Substep<double> substep{};
    substep.dt = plan.dt;
    substep.kick = 0.5 * (previous_dt + plan.dt);
    substep.previous_dt = previous_dt;
    const Eigen::Vector3d gravity = effective_gravity(scene, time - 0.5 * previous_dt, time + 0.5 * plan.dt);
    substep.acceleration_x = gravity.x();
    substep.acceleration_y = gravity.y();
    substep.acceleration_z = gravity.z();
    if (!scene.rains.empty()) {
      const Eigen::Vector3d wind = scene.rains.front().wind_m_s - container_velocity(scene, time);
      substep.wind_x = wind.x();
      substep.wind_y = wind.y();
      substep.wind_z = wind.z();
    }
    substep.box_count = lasting(boxes_end, time, length);
    substep.held_count = lasting(groups_end, time, length);
    substep.released_count = held_before - substep.held_count;
    set_pressure_solve(scene, substep.box_count < boxes_before, substep);
    substep.statistics = settings.statistics && s == count - 1 ? 1 : 0;
    plan.substeps.push_back(substep);
    previous_dt = plan.dt;
    held_before = substep.held_count;
    boxes_before = substep.box_count;
  }
  return plan;
}

}  // namespace squall
