#include "core/solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "boundary.h"
#include "core/rain.h"
#include "grid.h"

namespace squall {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr double k_largest_pressure = 1e12;  ///< m^2/s^2; beyond any water, and far from where single precision ends

double milliseconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

void check_shape(const Particles& particles, std::size_t room) {
  const std::size_t count = particles.size();
  if (particles.positions.size() != count || particles.velocities.size() != count)
    throw InputError("particles have " + std::to_string(count) + " ids, " + std::to_string(particles.positions.size()) +
                     " positions and " + std::to_string(particles.velocities.size()) + " velocities; give one of each");
  if (!particles.pressures.empty() && particles.pressures.size() != count)
    throw InputError("particles have " + std::to_string(count) + " ids and " +
                     std::to_string(particles.pressures.size()) + " pressures; give one of each, or no pressures");
  if (count > room)
    throw InputError(std::to_string(count) + " particles do not fit: there is room for " + std::to_string(room) +
                     "; raise max_particles of the scene's rain or enlarge its blocks");
}

void check_unique(std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  const auto twin = std::adjacent_find(ids.begin(), ids.end());
  if (twin != ids.end())
    throw InputError("particle id " + std::to_string(*twin) + " is given twice; ids must be unique");
}

/// Not finite where single precision would not be either, or further away than lost_distance on any side.
bool is_to_be_lost(const Params<double>& p, const Eigen::Vector3d& x, const Eigen::Vector3d& v) {
  const double position[3] = {x.x(), x.y(), x.z()};
  return !is_kept(&p, position) || !(v.squaredNorm() <= static_cast<double>(std::numeric_limits<float>::max()));
}

/// Marks what is to be lost; makes pressures what a solver can start from, one for each particle.
void make_ready(const Params<double>& p, Particles& particles) {
  particles.pressures.resize(particles.size(), 0.0);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double& pressure = particles.pressures[i];
    if (!(pressure >= 0.0 && pressure <= k_largest_pressure)) pressure = 0.0;
    if (!is_to_be_lost(p, particles.positions[i], particles.velocities[i])) continue;
    particles.positions[i].setConstant(static_cast<double>(SQUALL_LOST_COORDINATE));
    particles.velocities[i].setZero();
    pressure = 0.0;
  }
}

double largest_speed(const Particles& particles) {
  double largest = 0.0;
  for (const auto& velocity : particles.velocities) largest = std::max(largest, velocity.norm());
  return largest;
}

void check_step(const Scene& scene, const Settings& settings) {
  const double fixed = settings.fixed_step_s;
  if (!(fixed >= 0.0 && std::isfinite(fixed)))
    throw InputError("fixed_step_s = " + std::to_string(fixed) + " is no time step; 0 plans them");
  if (fixed > 0.0 && 1.0 / (scene.time.frame_rate_hz * fixed) > k_max_substeps + 0.5)
    throw InputError("fixed_step_s fits into a frame of frame_rate_hz = " + std::to_string(scene.time.frame_rate_hz) +
                     " more than " + std::to_string(k_max_substeps) + " times; raise either");
  if (fixed > 0.0) return;
  if (const std::string problem = step_problem(scene, settings.pressure); !problem.empty()) throw InputError(problem);
}

/// Takes from a frame's plan what comes after `done` sub-steps, at most so many; statistics are of its last one.
void keep_part(const Settings& settings, int done, int most, FramePlan& plan) {
  auto& substeps = plan.substeps;
  if (done >= static_cast<int>(substeps.size()))
    throw InputError("the state has done " + std::to_string(done) + " of the " + std::to_string(substeps.size()) +
                     " sub-steps of its frame; restore it into the scene it was taken from");
  substeps.erase(substeps.begin(), substeps.begin() + done);
  if (static_cast<int>(substeps.size()) > most) substeps.resize(static_cast<std::size_t>(most));
  substeps.back().statistics = settings.statistics ? 1 : 0;
}

}  // namespace

Solver::Solver(Scene scene, Settings settings) : scene_(std::move(scene)), settings_(std::move(settings)) {
  validate(scene_);
  if (settings_.threads < 0 || settings_.threads > 1024)
    throw InputError("threads " + std::to_string(settings_.threads) + " is outside [0, 1024]; 0 uses all");
  if (scene_.solver.xsph > 0.0 && settings_.pressure != Pressure::dfsph)
    throw InputError("xsph = " + std::to_string(scene_.solver.xsph) + " in [solver] needs pressure dfsph, not " +
                     to_string(settings_.pressure) + "; remove it or write 0");
  if (const std::string problem = ratio_problem(scene_, settings_.pressure); !problem.empty())
    throw InputError(problem);
  check_step(scene_, settings_);
  params_ = make_params(scene_, settings_.pressure);
  boxes_ = make_boxes(scene_, settings_.pressure);
  held_groups_ = make_held_groups(scene_);
  capacity_ = static_cast<std::size_t>(particle_capacity(scene_));
  clock_.rained.assign(scene_.rains.size(), 0);
}

void Solver::load(Particles particles) {
  check_shape(particles, capacity_);
  check_unique(particles.ids);
  make_ready(params_, particles);
  do_load(particles);
  count_ = particles.size();
  positions_ = {};
  report_ = {};
  clock_ = {};
  clock_.rained.assign(scene_.rains.size(), 0);
  clock_.max_speed = largest_speed(particles);
  for (const auto id : particles.ids) clock_.next_id = std::max(clock_.next_id, id + 1);
}

void Solver::append(Particles particles) {
  if (clock_.substep > 0)
    throw InputError("particles are added between frames, and sub-step " + std::to_string(clock_.substep) +
                     " of one is done; advance() to its end first");
  check_shape(particles, capacity_ - count_);
  make_ready(params_, particles);
  const double time = static_cast<double>(clock_.frame) / scene_.time.frame_rate_hz;
  Eigen::Vector3d half_kick = scene_.gravity_m_s2 * (0.5 * clock_.previous_dt);
  half_kick -= container_velocity(scene_, time) - container_velocity(scene_, time - 0.5 * clock_.previous_dt);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.ids[i] = clock_.next_id++;
    if (!is_lost(particles.positions[i].x())) particles.velocities[i] -= half_kick;
  }
  append_ready(particles);
}

void Solver::append_ready(const Particles& particles) {
  if (particles.size() == 0) return;
  positions_ = {};
  do_append(particles);
  count_ += particles.size();
  clock_.max_speed = std::max(clock_.max_speed, largest_speed(particles));
}

const FrameReport& Solver::advance(Delivery delivery) { return advance_part(k_max_substeps, delivery); }

const FrameReport& Solver::advance_substep() { return advance_part(1, Delivery::nothing); }

const FrameReport& Solver::advance_part(int most_substeps, Delivery delivery) {
  const auto start = SteadyClock::now();
  frame_start_ = start;
  positions_ = {};
  report_ = {};
  if (clock_.substep == 0) rain();

  FramePlan plan = plan_frame(scene_, settings_, clock_);
  const int substeps_of_frame = static_cast<int>(plan.substeps.size());
  keep_part(settings_, clock_.substep, most_substeps, plan);
  note_host_span("plan", report_.upload_ms, milliseconds_since(start));
  do_advance(plan, delivery, report_);
  if (delivery == Delivery::positions) {
    positions_ = do_positions();
    positions_.frame = plan.frame + 1 - static_cast<std::uint64_t>(report_.readback_latency_frames);
  }
  report_.frame_ms = milliseconds_since(start);
  finish_report(plan);
  finish_clock(plan, substeps_of_frame);
  return report_;
}

void Solver::rain() {
  Clock next = clock_;
  const Particles drops = release_drops(scene_, settings_.seed, next);
  check_shape(drops, capacity_ - count_);
  clock_ = next;
  append_ready(drops);
  report_.upload_ms = milliseconds_since(frame_start_);
  if (drops.size() > 0) note_host_span("rain", 0.0, report_.upload_ms);
}

void Solver::finish_clock(const FramePlan& plan, int substeps_of_frame) {
  clock_.substep += report_.substeps;
  clock_.max_speed_so_far = std::max(clock_.max_speed_so_far, report_.max_speed);
  clock_.max_acceleration_so_far = std::max(clock_.max_acceleration_so_far, report_.max_acceleration);
  if (clock_.substep < substeps_of_frame) return;
  clock_.frame += 1;
  clock_.previous_substeps = substeps_of_frame;
  clock_.previous_dt = plan.dt;
  clock_.max_speed = clock_.max_speed_so_far;
  clock_.max_acceleration = clock_.max_acceleration_so_far;
  clock_.substep = 0;
  clock_.max_speed_so_far = clock_.max_acceleration_so_far = 0.0;
}

void Solver::note_host_span(const char* name, double begin_ms, double end_ms) {
  if (settings_.trace) report_.spans.push_back({name, "host", begin_ms, end_ms});
}

void Solver::finish_report(const FramePlan& plan) {
  report_.frame = plan.frame;
  report_.substeps = static_cast<int>(plan.substeps.size());
  report_.dt_s = plan.dt;
  report_.compute_ms = report_.frame_ms - report_.upload_ms - report_.readback_ms;
  report_.particles = static_cast<std::int64_t>(count_);
  report_.readback_bytes = positions_.count * positions_.position_bytes();
  const double iterations = static_cast<double>(report_.density_iterations + report_.divergence_iterations);
  report_.iterations_mean = iterations / report_.substeps;
  // Each iteration is two, but for the first half of the divergence solve, which rides on the heavy pass, and for its
  // last push, which there is not; predict stands for the density solve's.
  if (settings_.pressure == Pressure::dfsph)
    report_.light_passes =
        2 * (report_.density_iterations + report_.divergence_iterations - static_cast<std::int64_t>(report_.substeps));
  report_.smoothing_viscosity = smoothing_viscosity(scene_, settings_.pressure);
  report_.time_step_limited =
      plan.limited && !(substeps_needed(scene_, settings_.pressure, report_.max_speed) <= k_max_substeps);
  report_.container_displacement =
      container_displacement(scene_, static_cast<double>(plan.frame + 1) / scene_.time.frame_rate_hz);
}

State Solver::state() { return {do_download(), clock_}; }

Fields Solver::fields() { return report_.substeps > 0 ? do_fields() : Fields{}; }

void Solver::restore(const State& state) {
  check_shape(state.particles, capacity_);
  check_unique(state.particles.ids);
  if (state.clock.rained.size() != scene_.rains.size())
    throw InputError("the state has " + std::to_string(state.clock.rained.size()) + " rains and the scene " +
                     std::to_string(scene_.rains.size()) + "; restore it into the scene it was saved from");
  if (state.clock.substep < 0)
    throw InputError("the state has done " + std::to_string(state.clock.substep) + " sub-steps of its frame");
  Particles particles = state.particles;
  make_ready(params_, particles);
  do_load(particles);
  count_ = particles.size();
  clock_ = state.clock;
  report_ = {};
  positions_ = {};
}

}  // namespace squall
