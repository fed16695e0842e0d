#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "backends.h"
#include "core/solver.h"

namespace squall::harness {

/// What a solver does wrong; nothing by default.
struct Wrong {
  std::uint64_t frame = std::numeric_limits<std::uint64_t>::max();  ///< where bits are changed
  int substep = 0;
  std::uint32_t particle = 0;
  int bit = 0;             ///< of the single-precision x, from the last place
  bool reorders = false;   ///< instead: swaps the first two particles after every sub-step of that frame
  bool remembers = false;  ///< only a solver that has not been restored does it: a fault of what no state holds
  bool miscounts = false;  ///< one neighbour more, always
  double noise = 0.0;      ///< relative, on every velocity after every sub-step
  std::uint64_t fails_at = std::numeric_limits<std::uint64_t>::max();  ///< frame in which the device is gone
};

/// The reference in single precision, with something wrong in it.
class WrongSolver final : public Solver {
 public:
  WrongSolver(const Scene& scene, const Settings& settings, Wrong wrong)
      : Solver(scene, settings), wrong_(wrong), inner_(make_solver("reference", scene, settings)) {}

  SolverInfo info() const override { return {"wrong", "a wrong device", "", 1, "", 0.0}; }

 private:
  void do_load(const Particles& particles) override {
    particles_ = particles;
    ++loads_;
  }
  void do_append(const Particles& particles) override {
    for (std::size_t i = 0; i < particles.size(); ++i)
      particles_.add(particles.ids[i], particles.positions[i], particles.velocities[i], particles.pressures[i]);
  }

  void do_advance(const FramePlan& plan, Delivery, FrameReport& report) override {
    if (plan.frame >= wrong_.fails_at) throw DeviceError("the wrong device is gone");
    inner_->restore({particles_, clock()});
    for (std::size_t s = 0; s < plan.substeps.size(); ++s) {
      const FrameReport& part = inner_->advance_substep();
      report.active = part.active;
      report.lost = part.lost;
      report.clamps += part.clamps;
      report.max_speed = std::max(report.max_speed, part.max_speed);
      report.max_acceleration = std::max(report.max_acceleration, part.max_acceleration);
      fields_ = inner_->fields();
      spoil(plan.frame, clock().substep + static_cast<int>(s));
    }
    particles_ = inner_->state().particles;
  }

  void spoil(std::uint64_t frame, int substep) {
    State state = inner_->state();
    Particles& particles = state.particles;
    // The next sort would put right what another order has done: it lasts for the frame.
    const bool here =
        frame == wrong_.frame && (substep == wrong_.substep || wrong_.reorders) && (!wrong_.remembers || loads_ < 2);
    if (here && wrong_.reorders) {
      std::swap(particles.ids[0], particles.ids[1]);
      std::swap(particles.positions[0], particles.positions[1]);
      std::swap(particles.velocities[0], particles.velocities[1]);
      std::swap(particles.pressures[0], particles.pressures[1]);
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (here && !wrong_.reorders && particles.ids[i] == wrong_.particle) flip(particles.positions[i].x());
      const double sign = (particles.ids[i] + frame) % 2 == 0 ? 1.0 : -1.0;
      for (int axis = 0; axis < 3; ++axis) {
        double& v = particles.velocities[i][axis];
        v = static_cast<double>(static_cast<float>(v * (1.0 + sign * wrong_.noise)));
      }
    }
    if (here || wrong_.noise > 0.0) inner_->restore(state);
  }
  void flip(double& x) const {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x)) ^ (1u << wrong_.bit);
    x = static_cast<double>(std::bit_cast<float>(bits));
  }

  PositionsView do_positions() override { return {}; }
  Particles do_download() override { return particles_; }
  Fields do_fields() override {
    Fields fields = fields_;
    if (wrong_.miscounts) ++fields.neighbours.front();
    return fields;
  }

  Wrong wrong_;
  std::unique_ptr<Solver> inner_;
  Particles particles_;
  Fields fields_;
  int loads_ = 0;
};

}  // namespace squall::harness
