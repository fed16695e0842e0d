#include "app/workload.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/terminal.h"
#include "core/errors.h"
#include "core/time_step.h"

namespace squall::app {

namespace {

/// Of other spacings, solvers or steps: each of them is refused or not, whatever is to be said of the scene itself.
bool runs_other_scenes(Command command) {
  return command == Command::sweep || command == Command::agree || command == Command::study;
}

}  // namespace

Workload load_workload(const Options& options) {
  Workload workload;
  Scene& scene = workload.scene;
  scene = load_scene(options.scene, options.pressure);
  if (options.particles) scale_to_particles(scene, *options.particles);
  if (options.dt_max_s) scene.solver.dt_max_s = *options.dt_max_s;
  validate(scene);
  workload.pressure = options.pressure ? *options.pressure : scene.solver.pressure.value_or(Settings{}.pressure);
  if (const std::string problem = ratio_problem(scene, workload.pressure); !problem.empty())
    throw InputError(options.scene + ": " + problem);  // before anything is written
  const std::string problem = runs_other_scenes(options.command) ? "" : step_problem(scene, workload.pressure);
  if (!problem.empty()) throw InputError(options.scene + ": " + problem);
  workload.info = {scene.name, scene_hash(scene), particle_capacity(scene)};
  // Stored scenes must find their particle files from any folder.
  const auto folder = std::filesystem::absolute(options.scene).parent_path();
  for (auto& file : scene.particle_files) file.file = (folder / file.file).lexically_normal().string();
  return workload;
}

Workload scaled(const Workload& workload, std::int64_t particles) {
  Workload result = workload;
  scale_to_particles(result.scene, particles);
  result.info = {result.scene.name, scene_hash(result.scene), particle_capacity(result.scene)};
  return result;
}

std::string headline(const Workload& workload) {
  const Scene& scene = workload.scene;
  return fmt::format("{}: {} particles{}, spacing {:.4g} mm, {}", scene.name, with_commas(workload.info.particles),
                     scene.rains.empty() ? "" : " in the end", 1000.0 * scene.fluid.spacing_m,
                     to_string(workload.pressure));
}

std::string print_workload(const Workload& workload) {
  Scene scene = workload.scene;
  scene.solver.pressure = workload.pressure;
  return print_scene(scene);
}

}  // namespace squall::app
