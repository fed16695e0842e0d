#include "harness/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <new>
#include <utility>

#include "core/state_hash.h"
#include "harness/delivered.h"
#include "harness/measures.h"

namespace squall::harness {

namespace {

/// Processor time of all threads [ms].
double processor_ms() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Delivery delivery_of(const Settings& settings) {
  return settings.readback == Readback::none ? Delivery::nothing : Delivery::positions;
}

/// Why positions are not those of the state; empty if they are, or none were asked for.
std::string check_delivery(const Delivered& delivered, const State& state, const Settings& settings) {
  if (delivery_of(settings) == Delivery::nothing) return "";
  if (delivered.frame() != state.clock.frame)
    return fmt::format("they are said to be of {} frames, the state is of {}", delivered.frame(), state.clock.frame);
  return delivered.problem(state.particles);
}

std::string too_long(const FrameReport& report, const Scene& scene, Pressure pressure) {
  return fmt::format("unstable after frame {}: {} sub-steps of {:.3g} s are too long; {}", report.frame,
                     report.substeps, report.dt_s,
                     step_problem(scene, pressure, report.max_speed, "water with a speed"));
}

void check_plan(const RunPlan& plan) {
  if (plan.frames < 1)
    throw InputError("a run of " + std::to_string(plan.frames) + " frames measures nothing; at least 1 is needed");
  if (plan.warm_up_frames < 0)
    throw InputError("warm-up of " + std::to_string(plan.warm_up_frames) + " frames; it cannot be negative");
}

}  // namespace

Run::Run(std::unique_ptr<Solver> solver, RunPlan plan) : solver_(std::move(solver)), plan_(std::move(plan)) {
  check_plan(plan_);
  start_ = solver_->state();
  state_ = start_;
  energy_in_ = energy_of_start();
}

double Run::energy_of_start() const {
  return plan_.energy_in_j ? *plan_.energy_in_j : total_energy(scene(), start_.particles);
}

bool Run::done() const { return !error_.empty() || steps_done_ >= steps_planned(); }

void Run::step() {
  if (done()) return;
  try {
    if (plan_.rewind && plan_.warm_up_frames > 0 && steps_done_ == plan_.warm_up_frames) rewind();
    advance();
    if (!error_.empty() && plan_.rewind && steps_done_ <= plan_.warm_up_frames) give_up_warm_up();
  } catch (const DeviceError& failure) {
    error_ = failure.what();
    device_failed_ = true;
  } catch (const std::bad_alloc&) {
    error_ = "out of memory; use fewer particles, or close what else needs memory";
    device_failed_ = true;
  }
}

void Run::rewind() {
  solver_->restore(start_);
  state_ = start_;
  energy_in_ = energy_of_start();
}

void Run::give_up_warm_up() {
  error_.clear();
  steps_done_ = plan_.warm_up_frames;
}

void Run::advance() {
  const double cpu_before = processor_ms();
  const auto begin = std::chrono::steady_clock::now();
  FrameReport report = solver_->advance(delivery_of(plan_.settings));
  const double cpu_ms = processor_ms() - cpu_before;
  const Delivered delivered(solver_->positions());  // before the state is asked for, which takes the view back
  std::string delivery_problem = check_delivery(delivered, state_, plan_.settings);
  take_state();
  if (!delivery_problem.empty()) delivery_problem = check_delivery(delivered, state_, plan_.settings);
  ++steps_done_;
  if (steps_done_ > plan_.warm_up_frames) {
    const double time_s = static_cast<double>(state_.clock.frame) / scene().time.frame_rate_hz;
    limit_spans(report);
    frames_.push_back({time_s, report, cpu_ms, state_hash_, begin});
  }
  check_end_state(report);
  if (error_.empty() && !delivery_problem.empty())
    error_ = fmt::format("wrong positions are delivered with frame {}: {}", report.frame, delivery_problem);
}

/// Spans stay in memory until the run is over.
void Run::limit_spans(FrameReport& report) {
  spans_left_ -= std::min(spans_left_, report.spans.size());
  if (spans_left_ == 0) report.spans.clear();
}

void Run::take_state() {
  const std::uint32_t first_new = state_.clock.next_id;
  state_ = solver_->state();
  state_hash_ = squall::state_hash(state_.particles, plan_.settings.precision);
  if (state_.clock.next_id > first_new) energy_in_ += total_energy(scene(), state_.particles, first_new);
}

void Run::check_end_state(const FrameReport& report) {
  const auto count = static_cast<std::int64_t>(state_.particles.size());
  const auto after = fmt::format("after frame {}", report.frame);
  if (!is_finite(state_.particles))
    error_ = fmt::format("a position or velocity is not finite {}", after);
  else if (report.time_step_limited)
    error_ = too_long(report, scene(), plan_.settings.pressure);
  else if (report.lost > 0)
    error_ = fmt::format("{} of {} particles are lost {}", report.lost, count, after);
  else if (report.particles != count)
    error_ = fmt::format("the report counts {} particles {}, the state {}", report.particles, after, count);
}

Row Run::row() const {
  Row row;
  row.plan = plan_;
  row.solver = solver_->info();
  row.error = error_;
  row.device_failed = device_failed_;
  row.interrupted = !done();
  row.particles = static_cast<std::int64_t>(state_.particles.size());
  row.start_frame = start_.clock.frame;
  row.lost_particles = solver_->report().lost;
  row.state_hash = state_hash_;
  row.density_tolerance = scene().solver.density_tolerance;
  summarise(frames_, 1.0 / scene().time.frame_rate_hz, row);
  const double energy = total_energy(scene(), state_.particles);
  if (energy_in_ != 0.0 && error_.empty()) row.energy_drift = (energy - energy_in_) / std::abs(energy_in_);
  return row;
}

Row run_to_end(Run& run, const AfterFrame& after_frame) {
  while (!run.done()) {
    const int before = run.steps_done();
    run.step();
    const bool did_a_frame = run.steps_done() > before;
    if (did_a_frame && after_frame && !after_frame(run)) break;
  }
  return run.row();
}

Row run_once(std::unique_ptr<Solver> solver, const RunPlan& plan, const AfterFrame& after_frame) {
  Run run(std::move(solver), plan);
  return run_to_end(run, after_frame);
}

Profile profile_run(const SolverFactory& make, RunPlan plan, const State& state) {
  if (plan.backend == "reference") return {};
  constexpr int k_frames = 4;
  const int frames = std::min(k_frames, plan.frames);
  plan.settings.profile = true;
  plan.settings.trace = false;
  Profile mean;
  try {
    const auto solver = make(plan);
    solver->restore(state);
    solver->advance(delivery_of(plan.settings));
    for (int frame = 0; frame < frames; ++frame) {
      const FrameReport report = solver->advance(delivery_of(plan.settings));
      for (const auto& [phase, ms] : report.phase_ms) mean.phase_ms[phase] += ms / frames;
      mean.readback_copy_ms += report.readback_copy_ms / frames;
      mean.readback_hidden_ms += report.readback_hidden_ms / frames;
    }
  } catch (const DeviceError&) {
    return {};
  }
  return mean;
}

}  // namespace squall::harness
