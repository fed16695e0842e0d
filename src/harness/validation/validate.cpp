#include "harness/validation/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "grid.h"
#include "harness/measures.h"
#include "harness/validation/observer.h"
#include "harness/water_warnings.h"

namespace squall::harness {

namespace {

Verdict verdict_of(const Check& check, const CaseRun& run) {
  Verdict verdict;
  for (const auto& failure : check.fails)
    if (failure.pressure == run.plan.settings.pressure) {
      verdict.expected_to_pass = false;
      verdict.reason = failure.reason;
    }
  verdict.finding = judge(check, run.scene, run.series);
  if (run.error.empty() && run.any_water) return verdict;
  verdict.finding.passed = false;
  // A run that ends early has failed, which a case may expect; values that it lacks are part of that.
  verdict.finding.lacks_values = run.error.empty();
  if (run.error.empty()) {
    verdict.finding.error = k_no_value;
    verdict.finding.points.clear();
  }
  verdict.finding.problem = run.error.empty()
                                ? fmt::format(
                                      "no particles from 0 to {:.4g} s: nothing was measured; the scene needs a block, "
                                      "particles, or rain that falls in this time",
                                      run.simulated_s)
                                : run.error;
  return verdict;
}

bool has_water(const State& state) {
  const auto& positions = state.particles.positions;
  return std::any_of(positions.begin(), positions.end(), [](const auto& x) { return !is_lost(x.x()); });
}

int frames_of(const Case& what, const Scene& scene) {
  const double frames = std::round(duration_of(what) * scene.time.frame_rate_hz);
  if (!(frames <= 1e7))
    throw InputError(
        fmt::format("case {} asks for {:g} s of water, more than 10,000,000 samples; lower duration_s, or the "
                    "last time of its table",
                    what.name, what.duration_s));
  return std::max(1, static_cast<int>(frames));
}

void summarise(const Run& run, CaseRun& result) {
  const Row row = run.row();
  result.solver = run.solver();
  result.error = row.error;
  result.device_failed = row.device_failed;
  result.particles = row.particles;
  result.simulated_s = row.simulated_s;
  result.wall_s = row.wall_s;
  result.iterations_mean = row.iterations_mean;
  result.steps = row.steps;
  result.clamps = row.clamps;
  result.unconverged = row.unconverged;
  result.warnings = water_warnings(row);
}

}  // namespace

Scene scene_of(const Case& what, const std::optional<std::int64_t>& particles) {
  Scene scene = what.scene;
  if (particles) scale_to_particles(scene, *particles);
  scene.time.frame_rate_hz *= what.samples_per_frame;
  validate(scene);
  return scene;
}

CaseRun run_case(const Case& what, const Scene& scene, RunPlan plan, const SceneSolverFactory& make,
                 const CaseProgress& progress) {
  CaseRun result;
  plan.warm_up_frames = 0;
  plan.frames = frames_of(what, scene);
  plan.settings.readback = Readback::none;
  result.plan = plan;
  result.scene = scene;
  Run run(make(plan, scene), plan);
  Observer observer(scene, plan.settings.pressure, what.samples_per_frame);
  observer.add(run.state(), nullptr);
  result.any_water = has_water(run.state());
  while (!run.done()) {
    run.step();
    if (!run.error().empty()) break;
    observer.add(run.state(), &run.frames().back().report);
    result.any_water = result.any_water || has_water(run.state());
    if (progress && !progress(static_cast<double>(run.steps_done()) / run.steps_planned())) {
      result.interrupted = !run.done();
      break;
    }
  }
  summarise(run, result);
  result.series = observer.series();
  for (const auto& check : what.checks) result.verdicts.push_back(verdict_of(check, result));
  return result;
}

bool all_as_expected(const std::vector<CaseResult>& results) {
  for (const auto& result : results)
    for (const auto& run : result.runs)
      if (!run.interrupted && !std::all_of(run.verdicts.begin(), run.verdicts.end(),
                                           [](const Verdict& verdict) { return verdict.as_expected(); }))
        return false;
  return true;
}

}  // namespace squall::harness
