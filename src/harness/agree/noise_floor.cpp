#include "harness/agree/noise_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mix.h"
#include "grid.h"

namespace squall::harness {

namespace {

struct Observable {
  const char* name;
  double (*value)(const Observation&);
};

/// Water that is there in one run alone is as far off as it lies from the corner. States that are not finite still
/// differ: their energies are no numbers.
double place(double length) { return std::isnan(length) ? 0.0 : length; }

constexpr Observable k_observables[] = {
    {"front_m", [](const Observation& o) { return place(o.front_m); }},
    {"height_m", [](const Observation& o) { return place(o.height_m); }},
    {"x_cm_m", [](const Observation& o) { return place(o.centre_m.x()); }},
    {"y_cm_m", [](const Observation& o) { return place(o.centre_m.y()); }},
    {"z_cm_m", [](const Observation& o) { return place(o.centre_m.z()); }},
    {"kinetic_j", [](const Observation& o) { return o.kinetic_j; }},
    {"potential_j", [](const Observation& o) { return o.potential_j; }},
};

double rms_distance(const Observable& observable, const Trajectory& a, const Trajectory& b) {
  const std::size_t frames = std::min(a.observations.size(), b.observations.size());
  if (frames == 0) return 0.0;
  double squares = 0.0;
  for (std::size_t f = 0; f < frames; ++f) {
    const double difference = observable.value(a.observations[f]) - observable.value(b.observations[f]);
    squares += difference * difference;
  }
  const double rms = std::sqrt(squares / static_cast<double>(frames));
  return std::isfinite(rms) ? rms : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<ObservedDistance> observed_distances(const Trajectory& run, const std::vector<Trajectory>& ensemble) {
  std::vector<ObservedDistance> distances;
  for (const Observable& observable : k_observables) {
    ObservedDistance found{observable.name, rms_distance(observable, run, ensemble.front()), 0.0};
    for (std::size_t i = 0; i < ensemble.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        found.floor = std::max(found.floor, rms_distance(observable, ensemble[i], ensemble[j]));
    distances.push_back(found);
  }
  return distances;
}

State perturbed(const State& state, std::uint64_t seed) {
  constexpr float k_infinity = std::numeric_limits<float>::infinity();
  const auto moved = [](double value, bool up) {
    return static_cast<double>(std::nextafter(static_cast<float>(value), up ? k_infinity : -k_infinity));
  };
  State result = state;
  Particles& particles = result.particles;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (is_lost(particles.positions[i].x())) continue;
    const std::uint64_t coins = mix64(mix64(seed) ^ particles.ids[i]);
    for (int axis = 0; axis < 3; ++axis) {
      double &x = particles.positions[i][axis], &v = particles.velocities[i][axis];
      x = moved(x, ((coins >> axis) & 1) != 0);
      v = moved(v, ((coins >> (3 + axis)) & 1) != 0);
    }
  }
  return result;
}

}  // namespace squall::harness
