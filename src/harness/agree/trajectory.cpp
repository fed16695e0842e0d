#include "harness/agree/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "grid.h"
#include "harness/agree/difference.h"

namespace squall::harness {

Trajectory follow(Solver& solver, int frames, const Remember& remember, const EveryFrame& go_on) {
  Trajectory run;
  if (remember.middle == 0) run.middle = solver.state();
  for (int frame = 1; frame <= frames; ++frame) {
    run.substeps += solver.advance(Delivery::nothing).substeps;
    State state = solver.state();
    run.hashes.push_back(exact_hash(state));
    const double time_s = static_cast<double>(state.clock.frame) / solver.scene().time.frame_rate_hz;
    run.observations.push_back(observe(solver.scene(), state.particles, time_s));
    if (!is_finite(state.particles)) {
      run.error = fmt::format("a position or velocity is not finite after frame {}", state.clock.frame - 1);
      break;
    }
    if (frame <= remember.states) run.states.push_back(state.particles);
    if (frame == remember.middle) run.middle = std::move(state);
    if (!go_on()) break;
  }
  return run;
}

Distance distance_between(const Particles& a, const Particles& b, double spacing) {
  std::unordered_map<std::uint32_t, std::size_t> places;
  for (std::size_t i = 0; i < b.size(); ++i) places[b.ids[i]] = i;
  Distance distance;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto found = places.find(a.ids[i]);
    if (found == places.end()) continue;
    const bool lost = is_lost(a.positions[i].x()) != 0;
    const bool both = lost && is_lost(b.positions[found->second].x());
    double length = both ? 0.0 : (a.positions[i] - b.positions[found->second]).norm() / spacing;
    if (!std::isfinite(length)) length = std::numeric_limits<double>::infinity();
    distance.max_dx = std::max(distance.max_dx, length);
    squares += length * length;
    ++count;
  }
  if (count > 0) distance.rms_dx = std::sqrt(squares / static_cast<double>(count));
  return distance;
}

std::vector<Distance> growth_between(const Trajectory& a, const Trajectory& b, double spacing) {
  std::vector<Distance> growth;
  for (std::size_t frame = 0; frame < std::min(a.states.size(), b.states.size()); ++frame)
    growth.push_back(distance_between(a.states[frame], b.states[frame], spacing));
  return growth;
}

std::size_t first_other_frame(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(in_a - a.begin());
}

}  // namespace squall::harness
