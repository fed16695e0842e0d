#include "harness/agree/one_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace squall::harness {

namespace {

using Places = std::unordered_map<std::uint32_t, std::size_t>;

Places places_of(const Particles& particles) {
  Places places;
  for (std::size_t i = 0; i < particles.size(); ++i) places[particles.ids[i]] = i;
  return places;
}

/// Gathers errors of one field; values of vectors come one by one.
class ErrorSum {
 public:
  void add(double expected, double value) {
    const double error = std::abs(value - expected);
    scale_ = std::max(scale_, std::abs(expected));
    max_ = std::isfinite(error) ? std::max(max_, error) : std::numeric_limits<double>::infinity();
    squares_ += error * error;
    ++count_;
  }
  Ulps ulps() const {
    if (count_ == 0 || max_ == 0.0) return {};
    const double ulp = unit_in_last_place(scale_);
    return {max_ / ulp, std::sqrt(squares_ / static_cast<double>(count_)) / ulp};
  }

 private:
  static double unit_in_last_place(double scale) {
    return scale > 0.0 ? std::ldexp(1.0, std::ilogb(scale) - 23)
                       : static_cast<double>(std::numeric_limits<float>::denorm_min());
  }
  double scale_ = 0.0, max_ = 0.0, squares_ = 0.0;
  std::int64_t count_ = 0;
};

void note_first(const OneStep& step, std::size_t i, IntegerCheck& check) {
  if (!check.first_particle && i < step.after.size()) check.first_particle = step.after.ids[i];
}

}  // namespace

OneStep take_one_step(Solver& solver, const State& start) {
  solver.restore(start);
  const FrameReport& report = solver.advance_substep();
  OneStep step;
  step.clamps = report.clamps;
  step.active = report.active;
  step.lost = report.lost;
  // The first sub-step of a frame follows one of the frame before (docs/physics.md, leap-frog).
  const double kick = 0.5 * (start.clock.previous_dt + report.dt_s);
  step.fields = solver.fields();
  step.after = solver.state().particles;
  const Places before = places_of(start.particles);
  for (std::size_t i = 0; i < step.fields.densities.size(); ++i) {
    const auto found = before.find(step.after.ids[i]);  // rain may have come
    const Eigen::Vector3d from =
        found != before.end() ? start.particles.velocities[found->second] : Eigen::Vector3d::Zero().eval();
    step.forces.push_back((step.after.velocities[i] - from) / kick);
  }
  return step;
}

IntegerCheck check_integers(const OneStep& expected, const OneStep& step) {
  IntegerCheck check;
  check.same_counts = expected.clamps == step.clamps && expected.active == step.active && expected.lost == step.lost;
  check.same_order = expected.after.ids == step.after.ids;
  for (std::size_t i = 0; !check.same_order && i < expected.after.size(); ++i)
    if (i >= step.after.size() || expected.after.ids[i] != step.after.ids[i]) note_first(expected, i, check);
  const auto &a = expected.fields.neighbours, &b = step.fields.neighbours;
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    if (i < a.size() && i < b.size() && a[i] == b[i]) continue;
    ++check.neighbours_differ;
    note_first(expected, i, check);
  }
  return check;
}

StepErrors step_errors(const OneStep& reference, const OneStep& step) {
  const Places places = places_of(step.after);
  StepErrors errors;
  ErrorSum density, pressure, force;
  for (std::size_t i = 0; i < reference.fields.densities.size(); ++i) {
    const auto found = places.find(reference.after.ids[i]);
    const std::size_t j = found != places.end() ? found->second : step.fields.densities.size();
    if (j >= step.fields.densities.size()) {
      ++errors.neighbours_differ;
      continue;
    }
    density.add(reference.fields.densities[i], step.fields.densities[j]);
    pressure.add(reference.fields.pressures[i], step.fields.pressures[j]);
    for (int axis = 0; axis < 3; ++axis) force.add(reference.forces[i][axis], step.forces[j][axis]);
    errors.neighbours_differ += reference.fields.neighbours[i] != step.fields.neighbours[j];
  }
  errors.density = density.ulps();
  errors.pressure = pressure.ulps();
  errors.force = force.ulps();
  return errors;
}

State stilled(const State& state) {
  State result = state;
  for (auto& velocity : result.particles.velocities) velocity.setZero();
  return result;
}

}  // namespace squall::harness
