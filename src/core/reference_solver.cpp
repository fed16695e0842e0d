#include "core/reference_solver.h"

#include <algorithm>
#include <cmath>

#include "core/precision.h"
#include "core/reference_dfsph.h"
#include "core/reference_passes.h"

namespace squall::reference {

namespace {

template <class Scalar>
Scalar cast(double value) {
  return static_cast<Scalar>(value);
}
template <class Scalar>
class ReferenceSolver final : public Solver {
 public:
  ReferenceSolver(const Scene& scene, const Settings& settings)
      : Solver(scene, settings),
        p_(in_precision<Scalar>(params())),
        terms_{settings.pressure, scene.fluid.viscosity_m2_s.has_value(), !scene.rains.empty(),
               scene.solver.xsph > 0.0} {
    for (const auto& box : boxes()) boxes_single_.push_back(in_precision<Scalar>(box));
  }

  SolverInfo info() const override { return {"reference", "one thread", "", 1, "", 0.0}; }

 private:
  void do_load(const Particles& particles) override {
    sorted_.particles.clear();
    do_append(particles);
  }

  void do_append(const Particles& particles) override {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      Particle<Scalar> particle;
      particle.id = particles.ids[i];
      for (int axis = 0; axis < 3; ++axis) {
        particle.x[axis] = cast<Scalar>(particles.positions[i][axis]);
        particle.v[axis] = cast<Scalar>(particles.velocities[i][axis]);
      }
      particle.pressure = cast<Scalar>(particles.pressures[i]);
      sorted_.particles.push_back(particle);
    }
  }

  void do_advance(const FramePlan& plan, Delivery delivery, FrameReport& report) override {
    max_speed2_ = max_acceleration2_ = 0;
    for (const auto& substep : plan.substeps) advance_substep(in_precision<Scalar>(substep), report);
    report.active = sorted_.active();
    report.lost = std::count_if(sorted_.particles.begin(), sorted_.particles.end(),
                                [](const auto& particle) { return is_lost(particle.x[0]); });
    report.max_speed = std::sqrt(static_cast<double>(max_speed2_));
    report.max_acceleration = std::sqrt(static_cast<double>(max_acceleration2_));
    delivered_.clear();
    if (delivery == Delivery::nothing) return;
    for (const auto& particle : sorted_.particles)
      for (int axis = 0; axis < 3; ++axis) delivered_.push_back(static_cast<float>(particle.x[axis]));
  }

  void advance_substep(const Substep<Scalar>& substep, FrameReport& report) {
    release(substep);
    sort(p_, held_groups(), substep.held_count, sorted_);
    const Walls<Scalar> walls{boxes_single_.data(), substep.box_count};
    const int active = sorted_.active();
    if (terms_.pressure == Pressure::dfsph) {
      solve_pressure(walls, substep, report);
    } else {
      for (int i = 0; i < active; ++i) density(p_, terms_, walls, sorted_, i);
      for (int i = 0; i < active; ++i) forces(p_, terms_, walls, sorted_, i);
    }
    if (substep.statistics != 0) fill_statistics(report);
    for (int i = 0; i < active; ++i) {
      auto& particle = sorted_.particles[static_cast<std::size_t>(i)];
      const int event = terms_.pressure == Pressure::dfsph ? drift(p_, walls, substep, particle)
                                                           : integrate(p_, terms_, walls, substep, particle);
      if ((event & SQUALL_CLAMPED) != 0) ++report.clamps;
      if ((event & SQUALL_LOST) == 0) note_maxima(particle);
    }
  }

  void solve_pressure(const Walls<Scalar>& walls, const Substep<Scalar>& substep, FrameReport& report) {
    SolveCost cost;
    make_incompressible(p_, terms_, walls, substep, scene().solver, sorted_, cost);
    report.density_iterations += cost.density_iterations;
    report.divergence_iterations += cost.divergence_iterations;
    report.density_iterations_max = std::max(report.density_iterations_max, cost.density_iterations);
    report.divergence_iterations_max = std::max(report.divergence_iterations_max, cost.divergence_iterations);
    report.unconverged += cost.unconverged;
  }

  /// Particles freed now start with half a kick, like everything at the start: the other half is taken back.
  void release(const Substep<Scalar>& substep) {
    const Scalar half = substep.previous_dt * p_.one_half;
    for (int g = substep.held_count; g < substep.held_count + substep.released_count; ++g) {
      const HeldGroup& group = held_groups()[static_cast<std::size_t>(g)];
      for (auto& particle : sorted_.particles) {
        if (particle.id < group.first_id || particle.id >= group.end_id) continue;
        particle.v[0] = fma(-half, substep.acceleration_x, particle.v[0]);
        particle.v[1] = fma(-half, substep.acceleration_y, particle.v[1]);
        particle.v[2] = fma(-half, substep.acceleration_z, particle.v[2]);
      }
    }
  }

  void note_maxima(const Particle<Scalar>& particle) {
    max_speed2_ = std::max(max_speed2_, squared_length(particle.v[0], particle.v[1], particle.v[2]));
    max_acceleration2_ = std::max(max_acceleration2_, squared_length(particle.acceleration[0], particle.acceleration[1],
                                                                     particle.acceleration[2]));
  }

  void fill_statistics(FrameReport& report) const {
    const int active = sorted_.active();
    double error_sum = 0.0, error_max = 0.0;
    std::int64_t neighbours = 0;
    for (int i = 0; i < active; ++i) {
      const auto& particle = sorted_.particles[static_cast<std::size_t>(i)];
      const double error = std::max(0.0, static_cast<double>(particle.density) - 1.0);
      error_sum += error;
      error_max = std::max(error_max, error);
      neighbours += particle.neighbours;
    }
    report.density_error_mean = active > 0 ? error_sum / active : 0.0;
    report.density_error_max = error_max;
    report.neighbours_mean = active > 0 ? static_cast<double>(neighbours) / active : 0.0;
  }

  PositionsView do_positions() override {
    return {delivered_.data(), PositionFormat::float32, 3 * sizeof(float), delivered_.size() / 3};
  }

  Particles do_download() override {
    Particles particles;
    particles.reserve(sorted_.particles.size());
    for (const auto& particle : sorted_.particles)
      particles.add(particle.id, {particle.x[0], particle.x[1], particle.x[2]},
                    {particle.v[0], particle.v[1], particle.v[2]},
                    terms_.pressure == Pressure::dfsph ? static_cast<double>(particle.pressure) : 0.0);
    return particles;
  }

  Fields do_fields() override {
    Fields fields;
    for (int i = 0; i < sorted_.active(); ++i) {
      const auto& particle = sorted_.particles[static_cast<std::size_t>(i)];
      fields.densities.push_back(static_cast<double>(particle.density));
      fields.pressures.push_back(static_cast<double>(particle.pressure));
      if (settings().statistics) fields.neighbours.push_back(particle.neighbours);
    }
    return fields;
  }

  Params<Scalar> p_;
  Terms terms_;
  std::vector<Box<Scalar>> boxes_single_;
  SortedParticles<Scalar> sorted_;
  Scalar max_speed2_ = 0;
  Scalar max_acceleration2_ = 0;
  std::vector<float> delivered_;
};

}  // namespace

std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings) {
  if (settings.precision == Precision::single_precision)
    return std::make_unique<ReferenceSolver<float>>(scene, settings);
  return std::make_unique<ReferenceSolver<double>>(scene, settings);
}

}  // namespace squall::reference
