#pragma once

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/solver.h"
#include "harness/run.h"

namespace squall::harness {

/// A closed box of 4 x 4 x 4 particles, spacing 0.1 m, without rain, at 10 frames per second.
inline Scene small_scene() {
  return parse_scene(R"(schema = 1
[time]
duration_s = 1.0
frame_rate_hz = 10.0
[fluid]
spacing_m = 0.1
[container]
min_m = [1.0, 2.0, 3.0]
max_m = [1.8, 2.8, 3.4]
[[block]]
min_m = [1.0, 2.0, 3.0]
max_m = [1.4, 2.4, 3.4]
)",
                     "small.toml");
}

/// What goes wrong, and after which frame (index from 0); never by default.
struct Faults {
  int differs_from = std::numeric_limits<int>::max();  ///< particle 5 is 0.01 m further in x
  int loses_at = std::numeric_limits<int>::max();
  int device_fails_at = std::numeric_limits<int>::max();
  int runs_out_of_memory_at = std::numeric_limits<int>::max();
  int hurries_from = std::numeric_limits<int>::max();       ///< reports 1e6 m/s, too fast for any number of sub-steps
  int delivers_wrong_at = std::numeric_limits<int>::max();  ///< position 7 is 0.01 m further in x than in the state
  bool states_not_finite = false;
  int frame_lasts_ms = 0;
};

/// Particles that drift with 1 m/s in z and feel nothing.
class FakeSolver final : public Solver {
 public:
  FakeSolver(const Scene& scene, const Settings& settings, Faults faults) : Solver(scene, settings), faults_(faults) {}

  SolverInfo info() const override { return {"fake", "fake device", "scalar", 1, "", 2.5}; }

 private:
  void do_load(const Particles& particles) override { particles_ = particles; }
  void do_append(const Particles& particles) override {
    for (std::size_t i = 0; i < particles.size(); ++i)
      particles_.add(particles.ids[i], particles.positions[i], particles.velocities[i]);
  }
  void do_advance(const FramePlan& plan, Delivery delivery, FrameReport& report) override {
    const auto frame = static_cast<int>(plan.frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(faults_.frame_lasts_ms));
    if (frame >= faults_.device_fails_at) throw DeviceError("the fake device is gone");
    if (frame >= faults_.runs_out_of_memory_at) throw std::bad_alloc();
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      particles_.positions[i].z() += 1e-3;
      if (frame == faults_.differs_from && particles_.ids[i] == 5) particles_.positions[i].x() += 0.01;
    }
    if (frame == faults_.loses_at) report.lost = 1;
    if (frame >= faults_.hurries_from) report.max_speed = 1e6;
    report.active = static_cast<std::int64_t>(particles_.size());
    report.neighbours_mean = 30.0;
    if (settings().profile) report.phase_ms["density"] = 3.0;
    if (settings().profile) report.readback_copy_ms = 2.0, report.readback_hidden_ms = 0.5;
    if (delivery == Delivery::positions) deliver(frame, report);
  }
  void deliver(int frame, FrameReport& report) {
    delivered_.clear();
    for (const auto& x : particles_.positions)
      for (int axis = 0; axis < 3; ++axis) delivered_.push_back(static_cast<float>(x[axis]));
    if (frame == faults_.delivers_wrong_at) delivered_[3 * 7] += 0.01f;
    report.readback_copied_bytes = 1000;
  }
  PositionsView do_positions() override {
    return {delivered_.data(), PositionFormat::float32, 3 * sizeof(float), delivered_.size() / 3};
  }
  Particles do_download() override {
    Particles copy = particles_;
    if (faults_.states_not_finite) copy.velocities.front().x() = std::numeric_limits<double>::quiet_NaN();
    return copy;
  }

  Fields do_fields() override { return {}; }

  Faults faults_;
  Particles particles_;
  std::vector<float> delivered_;
};

inline std::unique_ptr<Solver> make_fake(const RunPlan& plan, Faults faults = {}) {
  const Scene scene = small_scene();
  auto solver = std::make_unique<FakeSolver>(scene, plan.settings, faults);
  solver->load(initial_particles(scene));
  return solver;
}

inline RunPlan short_plan(const std::string& label, const std::string& backend = "opencl",
                          Readback readback = Readback::mapped) {
  RunPlan plan;
  plan.label = label;
  plan.backend = backend;
  plan.settings.readback = readback;
  plan.warm_up_frames = 2;
  plan.frames = 6;
  return plan;
}

}  // namespace squall::harness
