#include "harness/agree/difference.h"

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "core/mix.h"

namespace squall::harness {

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

bool same_bits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return bits(a.x()) == bits(b.x()) && bits(a.y()) == bits(b.y()) && bits(a.z()) == bits(b.z());
}

double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length = (a - b).norm();
  return std::isfinite(length) ? length : k_infinity;
}

double pressure_of(const Particles& particles, std::size_t i) {
  return particles.pressures.empty() ? 0.0 : particles.pressures[i];
}

/// What differs of a particle that both have; empty if nothing does. The order is the last to be blamed.
std::string what_differs(const Particles& a, std::size_t i, const Particles& b, std::size_t j) {
  if (!same_bits(a.positions[i], b.positions[j])) return "position";
  if (!same_bits(a.velocities[i], b.velocities[j])) return "velocity";
  if (bits(pressure_of(a, i)) != bits(pressure_of(b, j))) return "pressure";
  return i == j ? "" : "place in the order";
}

bool same_clock(const Clock& a, const Clock& b) {
  return a.frame == b.frame && a.substep == b.substep && a.previous_substeps == b.previous_substeps &&
         bits(a.previous_dt) == bits(b.previous_dt) && bits(a.max_speed) == bits(b.max_speed) &&
         bits(a.max_acceleration) == bits(b.max_acceleration) && bits(a.max_speed_so_far) == bits(b.max_speed_so_far) &&
         bits(a.max_acceleration_so_far) == bits(b.max_acceleration_so_far) && a.next_id == b.next_id &&
         a.rained == b.rained;
}

std::map<std::uint32_t, std::size_t> places_by_id(const Particles& particles) {
  std::map<std::uint32_t, std::size_t> places;
  for (std::size_t i = 0; i < particles.size(); ++i) places[particles.ids[i]] = i;
  return places;
}

class Comparison {
 public:
  explicit Comparison(double spacing) : spacing_(spacing) {}

  void only_in_one(std::uint32_t id) { note(id, "presence", k_infinity, k_infinity); }
  void in_both(const Particles& a, std::size_t i, const Particles& b, std::size_t j) {
    const std::string what = what_differs(a, i, b, j);
    if (!what.empty())
      note(a.ids[i], what, distance(a.positions[i], b.positions[j]) / spacing_,
           distance(a.velocities[i], b.velocities[j]));
  }
  const std::optional<StateDifference>& result() const { return result_; }

 private:
  void note(std::uint32_t id, const std::string& what, double position_dx, double velocity) {
    if (!result_) result_ = StateDifference{id, what, 0, 0.0, 0.0};
    ++result_->particles;
    result_->max_position_dx = std::max(result_->max_position_dx, position_dx);
    result_->max_velocity = std::max(result_->max_velocity, velocity);
  }
  double spacing_;
  std::optional<StateDifference> result_;
};

}  // namespace

std::uint64_t exact_hash(const State& state) {
  const Clock& clock = state.clock;
  const Particles& particles = state.particles;
  std::uint64_t chain = mix64(clock.frame ^ (std::uint64_t{clock.next_id} << 32));
  const auto add = [&](std::uint64_t value) { chain = mix64(chain ^ value); };
  for (const double value : {clock.previous_dt, clock.max_speed, clock.max_acceleration}) add(bits(value));
  add(static_cast<std::uint64_t>(clock.previous_substeps));
  for (std::size_t i = 0; i < particles.size(); ++i) {
    add(particles.ids[i]);
    for (int axis = 0; axis < 3; ++axis) add(bits(particles.positions[i][axis]));
    for (int axis = 0; axis < 3; ++axis) add(bits(particles.velocities[i][axis]));
    add(bits(pressure_of(particles, i)));
  }
  return chain;
}

std::optional<StateDifference> compare_states(const State& a, const State& b, double spacing) {
  const auto in_a = places_by_id(a.particles), in_b = places_by_id(b.particles);
  Comparison comparison(spacing);
  auto i = in_a.begin();
  auto j = in_b.begin();
  while (i != in_a.end() || j != in_b.end()) {
    if (j == in_b.end() || (i != in_a.end() && i->first < j->first))
      comparison.only_in_one((i++)->first);
    else if (i == in_a.end() || j->first < i->first)
      comparison.only_in_one((j++)->first);
    else
      comparison.in_both(a.particles, (i++)->second, b.particles, (j++)->second);
  }
  if (comparison.result() || same_clock(a.clock, b.clock)) return comparison.result();
  return StateDifference{0, "largest speed or acceleration of the frame", 0, 0.0, 0.0};
}

std::optional<FirstDifference> locate_difference(Solver& a, Solver& b, const State& before) {
  const double spacing = a.scene().fluid.spacing_m;
  a.restore(before);
  b.restore(before);
  for (int substep = 0; a.clock().frame == before.clock.frame && b.clock().frame == before.clock.frame; ++substep) {
    a.advance_substep();
    b.advance_substep();
    if (const auto difference = compare_states(a.state(), b.state(), spacing))
      return FirstDifference{before.clock.frame, substep, *difference, true};
  }
  return std::nullopt;
}

}  // namespace squall::harness
