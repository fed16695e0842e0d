#include "bench_support/cases.h"

#include <algorithm>
#include <cmath>

#include "backends.h"
#include "core/state_hash.h"

namespace squall::bench {

namespace {

constexpr double k_collapse_s = 0.2;
constexpr int k_settling_substeps = 40;  ///< after a split: the lattices of neighbours know nothing of each other

Scene scene_of(Size size) {
  Scene scene = load_scene(SQUALL_SCENES_DIR "/collapse.toml");
  scale_to_particles(scene, size.particles());
  // Shorter frames for shorter sub-steps: some ten to twenty of them. 120 Hz for 18 layers.
  const double finer = size.layers * size.split / 18.0;
  scene.time.frame_rate_hz = std::clamp(120.0 * finer * finer, 60.0, 1000.0);
  scene.time.duration_s = 10.0;
  return scene;
}

std::unique_ptr<Solver> solver_for(const Scene& scene, Pressure pressure, bool statistics) {
  Settings settings;
  settings.pressure = pressure;
  settings.statistics = statistics;
  return make_solver("omp", scene, settings);
}

/// The column of `layers`, collapsed for k_collapse_s (a tenth of it to see that it runs).
State collapsed(Pressure pressure, int layers, Effort effort) {
  const auto solver = solver_for(scene_of({layers, 1}), pressure, false);
  const double duration_s = effort == Effort::smoke ? 0.1 * k_collapse_s : k_collapse_s;
  const double frames = duration_s * solver->scene().time.frame_rate_hz;
  for (long frame = 0; frame < std::lround(frames); ++frame) solver->advance(Delivery::nothing);
  return solver->state();
}

State settled(const Scene& scene, Pressure pressure, Size size, const Particles& coarse) {
  const auto solver = solver_for(scene, pressure, false);
  const Eigen::Vector3d container = scene.container.max_m - scene.container.min_m;
  const double spacing = scene.fluid.spacing_m;
  solver->load(split_particles(coarse, size.split, size.split * spacing, container, 0.25 * spacing));
  for (int substeps = 0; substeps < k_settling_substeps;) {
    substeps += solver->advance(Delivery::nothing).substeps;
    // With a new clock: the plan would remember the accelerations that follow the split for many frames.
    solver->load(solver->state().particles);
  }
  return solver->state();
}

/// What one frame gives, asked of a run with statistics, which change no bit.
void note_expectations(Case& made) {
  const auto solver = solver_for(made.scene, made.pressure, true);
  solver->restore(made.state);
  const FrameReport& report = solver->advance(Delivery::nothing);
  made.active = report.active;
  made.neighbours_mean = report.neighbours_mean;
  made.density_error_mean = report.density_error_mean;
  made.end_hash = state_hash(solver->state().particles, Precision::single_precision);
}

}  // namespace

std::string case_name(Pressure pressure, Size size) {
  return std::string(to_string(pressure)) + "/" + std::to_string(size.particles());
}

std::vector<Size> sizes_for(Effort effort) {
  if (effort == Effort::smoke) return {{6, 1}};
  std::vector<Size> sizes{{18, 1}, {18, 2}};
  if (effort == Effort::full) sizes.push_back({40, 2});
  return sizes;
}

Particles split_particles(const Particles& particles, int k, double spacing, const Eigen::Vector3d& container,
                          double margin) {
  Particles children;
  children.reserve(particles.size() * static_cast<std::size_t>(k * k * k));
  const auto offset = [&](int i) { return ((i + 0.5) / k - 0.5) * spacing; };
  const Eigen::Vector3d low = Eigen::Vector3d::Constant(margin), high = container - low;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (int z = 0; z < k; ++z)
      for (int y = 0; y < k; ++y)
        for (int x = 0; x < k; ++x) {
          Eigen::Vector3d place = particles.positions[i] + Eigen::Vector3d(offset(x), offset(y), offset(z));
          children.add(static_cast<std::uint32_t>(children.size()), place.cwiseMax(low).cwiseMin(high),
                       particles.velocities[i]);
        }
  return children;
}

const Case& Cases::get(Pressure pressure, Size size) {
  auto& place = cases_[{pressure, size.particles()}];
  if (place) return *place;
  auto made = std::make_unique<Case>();
  made->scene = scene_of(size);
  made->pressure = pressure;
  made->size = size;
  made->params = to_single(make_params(made->scene, pressure));
  made->state = collapsed(pressure, size.layers, effort_);
  if (size.split > 1) made->state = settled(made->scene, pressure, size, made->state.particles);
  note_expectations(*made);
  place = std::move(made);
  return *place;
}

}  // namespace squall::bench
