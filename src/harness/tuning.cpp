#include "harness/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "core/errors.h"

namespace squall::harness {

namespace {

using Clock = std::chrono::steady_clock;

/// The choices, one dimension after the other: each step changes the best choice so far.
using Step = std::function<void(WorkChoice&)>;

std::vector<Step> steps_for(const RunPlan& plan, const DeviceInfo& device) {
  std::vector<Step> steps;
  const auto add = [&](auto member, std::initializer_list<int> values) {
    for (const int value : values) steps.push_back([=](WorkChoice& choice) { choice.work.*member = value; });
  };
  const bool vectors = device.kind == "cpu" && plan.settings.simd != Simd::scalar;
  if (vectors && plan.settings.simd == Simd::best)
    for (const Simd simd : {Simd::avx2, Simd::avx512}) steps.push_back([=](WorkChoice& choice) { choice.simd = simd; });
  if (vectors) {
    add(&WorkSizes::parts, {1, 2, 8, 16});
    add(&WorkSizes::chunks, {1, 2, 4, 8});
  } else {
    add(&WorkSizes::group, {32, 128, 256});
  }
  return steps;
}

class Tuner {
 public:
  Tuner(const SolverFactory& make, RunPlan plan) : make_(make), plan_(std::move(plan)) {
    plan_.settings.readback = Readback::none;
    plan_.settings.profile = false;
    plan_.settings.trace = false;
  }

  /// [ms] per sub-step.
  double measure(const WorkChoice& choice) {
    plan_.settings.simd = choice.simd;
    plan_.settings.work = choice.work;
    const auto solver = make_(plan_);
    const State start = solver->state();
    const double first_ms = solver->advance(Delivery::nothing).frame_ms;
    solver->restore(start);
    // Every choice sees the same frames: as many as half a second holds.
    if (frames_ == 0) frames_ = std::clamp(static_cast<int>(500.0 / std::max(first_ms, 1.0)), 1, 8);
    double least = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < frames_; ++frame) {
      const FrameReport& report = solver->advance(Delivery::nothing);
      least = std::min(least, report.frame_ms / std::max(report.substeps, 1));
    }
    return least;
  }

 private:
  const SolverFactory& make_;
  RunPlan plan_;
  int frames_ = 0;
};

}  // namespace

Tuning tune(const SolverFactory& make, RunPlan plan, const DeviceInfo& device, std::chrono::seconds limit,
            const GoOn& go_on) {
  constexpr double k_worth_it = 0.98;  // less is noise
  const auto start = Clock::now();
  const std::vector<Step> steps = steps_for(plan, device);
  Tuning tuning;
  tuning.best.simd = plan.settings.simd;
  Tuner tuner(make, std::move(plan));
  double best_ms = tuner.measure(tuning.best);
  tuning.trials.push_back({tuning.best, best_ms});
  for (const Step& step : steps) {
    WorkChoice choice = tuning.best;
    step(choice);
    if (choice == tuning.best) continue;
    if (Clock::now() - start > limit || (go_on && !go_on())) {
      tuning.complete = false;
      break;
    }
    double ms = 0.0;
    try {
      ms = tuner.measure(choice);
    } catch (const InputError&) {
      continue;  // larger than the device allows
    } catch (const DeviceError&) {
      continue;
    }
    tuning.trials.push_back({choice, ms});
    // What looks faster must be so again, against the best as it runs now: machines have slow minutes.
    if (ms >= k_worth_it * best_ms || tuner.measure(choice) >= k_worth_it * tuner.measure(tuning.best)) continue;
    best_ms = ms;
    tuning.best = choice;
  }
  return tuning;
}

std::string to_string(const WorkChoice& choice) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (choice.simd == Simd::scalar) add("a particle per work-item");
  if (choice.simd == Simd::avx2) add("float8");
  if (choice.simd == Simd::avx512) add("float16");
  if (choice.work.group > 0) add(fmt::format("work groups of {}", choice.work.group));
  if (choice.work.parts > 0) add(fmt::format("parts per unit: {}", choice.work.parts));
  if (choice.work.chunks > 0) add(fmt::format("chunks per unit: {}", choice.work.chunks));
  return text.empty() ? "as the device suggests" : text;
}

}  // namespace squall::harness
