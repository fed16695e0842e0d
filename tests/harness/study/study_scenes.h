#pragma once

#include "backends.h"
#include "harness/study/study.h"

namespace squall::harness {

/// 64 particles, spacing 0.1 m, that fall over on the floor of a box four times as wide, at 30 frames per second.
inline Scene falling_column() {
  return parse_scene(R"(schema = 1
[time]
duration_s = 1.0
frame_rate_hz = 30.0
[fluid]
spacing_m = 0.1
viscosity_m2_s = 1e-3
[container]
min_m = [0.0, 0.0, 0.0]
max_m = [1.6, 0.8, 0.4]
[[block]]
min_m = [0.0, 0.0, 0.0]
max_m = [0.4, 0.4, 0.4]
)",
                     "column.toml");
}

inline RunPlan reference_plan(int frames) {
  RunPlan plan;
  plan.label = "reference, double";
  plan.backend = "reference";
  plan.settings.precision = Precision::double_precision;
  plan.warm_up_frames = 0;
  plan.frames = frames;
  return plan;
}

/// One solver, changing these things alone, on the reference backend.
inline StudySubjects small_study(Pressure pressure, const std::vector<StudyAxis>& axes) {
  StudySubjects subjects;
  subjects.scene = falling_column();
  subjects.pressures = {pressure};
  subjects.plans = {reference_plan(6)};
  subjects.double_plan = reference_plan(6);
  subjects.axes = axes;
  subjects.ranges = quick_ranges();
  subjects.ranges.perturbed = 2;
  subjects.ranges.repeats = 1;
  return subjects;
}

inline std::unique_ptr<Solver> make_any(const RunPlan& plan, const Scene& scene) {
  return make_solver(plan.backend, scene, plan.settings);
}

}  // namespace squall::harness
