#include "harness/study/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "core/time_step.h"
#include "harness/report/plain_text.h"

namespace squall::harness {

namespace {

/// Step, tolerance and xsph of a scene by factors. xsph dt/dt_max is what smooths in a sub-step: with dt_max it has to
/// change so that the viscosity it amounts to stays (docs/dfsph.md).
Scene with_factors(Scene scene, double step, double tolerance) {
  scene.solver.cfl *= step;
  scene.solver.dt_max_s *= step;
  scene.solver.xsph *= step;
  scene.solver.density_tolerance *= tolerance;
  scene.solver.divergence_tolerance *= tolerance;
  return scene;
}

class PointMaker {
 public:
  explicit PointMaker(const StudySubjects& subjects) : subjects_(subjects) {}

  StudyPoints make() {
    for (const Pressure pressure : subjects_.pressures) {
      add_base(pressure);
      if (varies(StudyAxis::spacing)) add_spacings(pressure);
      if (varies(StudyAxis::ratio)) add_ratios(pressure);
    }
    return std::move(result_);
  }

 private:
  bool varies(StudyAxis axis) const { return std::count(subjects_.axes.begin(), subjects_.axes.end(), axis) > 0; }

  std::size_t add_model(Pressure pressure, const Scene& scene, const std::string& suffix) {
    result_.models.push_back({to_string(pressure) + suffix, pressure, scene, suffix.empty()});
    return result_.models.size() - 1;
  }

  void add_base(Pressure pressure) {
    if (const auto problem = ratio_problem(subjects_.scene, pressure); !problem.empty())
      return note(std::string(to_string(pressure)) + " is left out: " + problem);
    const auto model = add_model(pressure, subjects_.scene, "");
    const RunPlan& plan = subjects_.plans.front();
    add(StudyAxis::step, model, plan, 1.0, 1.0, "");
    if (varies(StudyAxis::step))
      for (const double factor : subjects_.ranges.step)
        if (factor != 1.0) add(StudyAxis::step, model, plan, factor, 1.0, fmt::format("step x{:g}", factor));
    if (varies(StudyAxis::tolerance) && pressure == Pressure::dfsph)
      for (const double factor : subjects_.ranges.tolerance)
        add(StudyAxis::tolerance, model, plan, 1.0, factor, fmt::format("tolerance x{:g}", factor));
    for (std::size_t i = 1; i < subjects_.plans.size(); ++i) add_beside(model, subjects_.plans[i]);
  }

  /// Another backend or precision at the scene's own setting.
  void add_beside(std::size_t model, const RunPlan& plan) {
    const RunPlan& base = subjects_.plans.front();
    const bool same_precision = plan.settings.precision == base.settings.precision;
    const StudyAxis axis = same_precision ? StudyAxis::backend : StudyAxis::precision;
    if (varies(axis)) add(axis, model, plan, 1.0, 1.0, plan.label);
  }

  void add_spacings(Pressure pressure) {
    if (ratio_problem(subjects_.scene, pressure).empty())
      for (const double factor : subjects_.ranges.spacing) add_spacing(pressure, factor);
  }

  void add_spacing(Pressure pressure, double factor) {
    Scene scene = subjects_.scene;
    try {
      const auto count = static_cast<double>(particle_capacity(scene));
      scale_to_particles(scene, std::max<std::int64_t>(1, std::llround(factor * count)));
      validate(scene);
    } catch (const InputError& refusal) {
      return note(fmt::format("spacing x{:g} in particles is left out: {}", factor, refusal.what()));
    }
    const auto spacing = scene.fluid.spacing_m;
    const bool known = std::any_of(result_.models.begin(), result_.models.end(), [&](const StudyModel& model) {
      return model.pressure == pressure && model.scene.fluid.spacing_m == spacing;
    });
    if (known) return;
    const std::string what = fmt::format("dx {:.4g} mm", 1e3 * spacing);
    const auto model = add_model(pressure, scene, ", " + what);
    for (const double step : subjects_.ranges.spacing_steps)
      add(StudyAxis::spacing, model, subjects_.plans.front(), step, 1.0,
          what + (step == 1.0 ? "" : fmt::format(", step x{:g}", step)));
  }

  void add_ratios(Pressure pressure) {
    for (const double ratio : subjects_.ranges.ratio) {
      Scene scene = subjects_.scene;
      if (std::abs(ratio - scene.fluid.support_ratio) < 1e-9) continue;
      scene.fluid.support_ratio = ratio;
      const std::string what = fmt::format("H/dx {:g}", ratio);
      if (!ratio_problem(scene, pressure).empty()) continue;
      const auto model = add_model(pressure, scene, ", " + what);
      add(StudyAxis::ratio, model, subjects_.plans.front(), 1.0, 1.0, what);
    }
  }

  void add(StudyAxis axis, std::size_t model, RunPlan plan, double step, double tolerance, const std::string& what) {
    const StudyModel& of = result_.models[model];
    plan.settings.pressure = of.pressure;
    StudyPoint point;
    point.name = to_string(of.pressure) + (what.empty() ? std::string() : ", " + what);
    point.axis = axis;
    point.model = model;
    point.step_factor = step;
    point.tolerance_factor = tolerance;
    point.run.scene = with_factors(of.scene, step, tolerance);
    point.run.plan = std::move(plan);
    point.overrides = overrides_between(subjects_.scene, point.run.scene);
    try {
      validate(point.run.scene);
    } catch (const InputError& refusal) {
      return note(point.name + " is left out: " + refusal.what());
    }
    if (const auto problem = step_problem(point.run.scene, of.pressure); !problem.empty())
      return note(point.name + " is left out: " + problem);
    result_.points.push_back(std::move(point));
  }

  void note(const std::string& text) {
    if (std::find(result_.notes.begin(), result_.notes.end(), text) == result_.notes.end())
      result_.notes.push_back(text);
  }

  const StudySubjects& subjects_;
  StudyPoints result_;
};

}  // namespace

const std::vector<StudyAxis>& study_axes() {
  static const std::vector<StudyAxis> all{StudyAxis::step,    StudyAxis::tolerance, StudyAxis::ratio,
                                          StudyAxis::spacing, StudyAxis::precision, StudyAxis::backend};
  return all;
}

const char* to_string(StudyAxis axis) {
  switch (axis) {
    case StudyAxis::step:
      return "step";
    case StudyAxis::tolerance:
      return "tolerance";
    case StudyAxis::ratio:
      return "ratio";
    case StudyAxis::spacing:
      return "spacing";
    case StudyAxis::precision:
      return "precision";
    case StudyAxis::backend:
      return "backend";
  }
  return "";
}

StudyRanges quick_ranges() { return {{2.0, 1.0, 0.5}, {10.0}, {1.7}, {0.25}, {1.0}, 3, 3}; }

StudyRanges full_ranges() {
  return {{4.0, 2.0, 1.0, 0.5, 0.25}, {10.0, 0.1}, {1.6, 1.8, 2.2}, {0.5, 0.25}, {2.0, 1.0}, 5, 5};
}

StudyPoints make_points(const StudySubjects& subjects) { return PointMaker(subjects).make(); }

StudyRun reference_run(const StudySubjects& subjects, const StudyPoints& points, std::size_t model, double finest_dt_s,
                       int most_substeps) {
  constexpr double k_eighth = 0.125;
  // What a solve leaves is density; the pressure it stands for goes with 1/dt^2. Nothing that a scene may say is too
  // tight.
  constexpr double k_tightest = 1e-7;
  constexpr int k_iterations = 1000;
  constexpr int k_substeps = 400;  // of a frame: room for water that is faster than the points found it
  const StudyModel& of = points.models[model];
  double step = 1.0;
  for (const auto& point : points.points) {
    if (point.model == model) step = std::min(step, point.step_factor);
  }
  StudyRun run;
  run.plan = subjects.double_plan;
  run.plan.settings.pressure = of.pressure;
  run.scene = with_factors(of.scene, k_eighth * step, 1.0);
  auto& solver = run.scene.solver;
  const double viscosity_kept = solver.xsph / solver.dt_max_s;
  solver.dt_max_s = std::min(solver.dt_max_s, k_eighth * finest_dt_s);
  solver.xsph = viscosity_kept * solver.dt_max_s;
  if (of.pressure == Pressure::dfsph) {
    solver.density_tolerance = solver.divergence_tolerance = k_tightest;
    solver.max_iterations = std::max(solver.max_iterations, k_iterations);
  }
  run.every = std::max(1, static_cast<int>(std::ceil(8.0 * most_substeps / k_substeps)));
  run.scene.time.frame_rate_hz *= run.every;
  run.plan.frames *= run.every;
  run.plan.label = of.name + ", reference";
  validate(run.scene);
  if (const auto problem = step_problem(run.scene, of.pressure); !problem.empty()) throw InputError(problem);
  return run;
}

std::vector<StudyRun> noise_runs(const StudySubjects& subjects, const StudyPoints& points, std::size_t model) {
  const StudyModel& of = points.models[model];
  std::vector<StudyRun> runs;
  if (initial_particles(of.scene).size() == 0 || subjects.ranges.perturbed < 1) return runs;
  if (!step_problem(of.scene, of.pressure).empty()) return runs;
  for (int number = 0; number <= subjects.ranges.perturbed; ++number) {
    StudyRun run;
    run.plan = subjects.double_plan;
    run.plan.settings.pressure = of.pressure;
    run.plan.label = of.name + (number == 0 ? ", double" : fmt::format(", perturbed start {}", number));
    run.scene = of.scene;
    run.jitter = number;
    runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<std::string> overrides_between(const Scene& from, const Scene& to) {
  std::vector<std::string> lines;
  const auto add = [&](const char* table, const char* key, double before, double after) {
    if (before != after) lines.push_back(fmt::format("[{}] {} = {}", table, key, after));
  };
  add("time", "frame_rate_hz", from.time.frame_rate_hz, to.time.frame_rate_hz);
  add("fluid", "spacing_m", from.fluid.spacing_m, to.fluid.spacing_m);
  add("fluid", "support_ratio", from.fluid.support_ratio, to.fluid.support_ratio);
  add("solver", "cfl", from.solver.cfl, to.solver.cfl);
  add("solver", "dt_max_s", from.solver.dt_max_s, to.solver.dt_max_s);
  add("solver", "density_tolerance", from.solver.density_tolerance, to.solver.density_tolerance);
  add("solver", "divergence_tolerance", from.solver.divergence_tolerance, to.solver.divergence_tolerance);
  add("solver", "max_iterations", from.solver.max_iterations, to.solver.max_iterations);
  add("solver", "xsph", from.solver.xsph, to.solver.xsph);
  for (std::size_t i = 0; i < std::min(from.rains.size(), to.rains.size()); ++i) {
    const auto &before = from.rains[i], &after = to.rains[i];
    if (before.particles_per_s && after.particles_per_s)
      add("rain", "particles_per_s", *before.particles_per_s, *after.particles_per_s);
    add("rain", "max_particles", static_cast<double>(before.max_particles), static_cast<double>(after.max_particles));
  }
  return lines;
}

}  // namespace squall::harness
