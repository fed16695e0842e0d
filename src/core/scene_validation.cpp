#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/fill.h"
#include "core/frame_plan.h"
#include "core/scene.h"
#include "core/scene_checks.h"
#include "core/scene_keys.h"

namespace squall {
namespace scene_keys {
namespace {

/// The checks of a whole scene in the order of its file, so that the first fault is the one to mend first.
class Order : private Checks {
 public:
  using Checks::Checks;

  void check() const {
    check_version();
    check_time();
    check_solver();
    check_container();
    for_each("container.motion", scene().container.motions, &Checks::check_motion);
    for_each("box", scene().boxes, &Checks::check_box);
    for_each("block", scene().blocks, &Checks::check_block);
    check_blocks_apart();
    for_each("particles", scene().particle_files, &Checks::check_particles);
    for_each("rain", scene().rains, &Checks::check_rain);
    for_each("gauge", scene().gauges, &Checks::check_gauge);
    check_count();
    check_places();
  }

 private:
  template <class Entry>
  void for_each(const char* table, const std::vector<Entry>& list,
                void (Checks::*check_one)(const SectionName&, const Entry&) const) const {
    for (std::size_t i = 0; i < list.size(); ++i) (this->*check_one)(SectionName{table, i + 1}, list[i]);
  }

  void check_version() const {
    if (scene().fluid.surface_tension_n_m)
      fail({"fluid"}, "surface_tension_n_m", "surface tension is not in this version; remove surface_tension_n_m");
  }

  void check_time() const {
    const double needed = 1.0 / (scene().time.frame_rate_hz * scene().solver.dt_max_s);
    if (needed > k_max_substeps)
      fail({"time"}, "frame_rate_hz",
           "frame_rate_hz = " + number_text(scene().time.frame_rate_hz) + " needs " + number_text(std::ceil(needed)) +
               " sub-steps of dt_max_s = " + number_text(scene().solver.dt_max_s) + " per frame; allowed are " +
               std::to_string(k_max_substeps) + "; raise frame_rate_hz or dt_max_s");
  }

  void check_solver() const {
    const auto pressure = scene().solver.pressure;
    if (scene().solver.xsph > 0.0 && pressure && *pressure != Pressure::dfsph)
      fail({"solver"}, "xsph",
           "xsph = " + number_text(scene().solver.xsph) + " needs pressure dfsph, not " + to_string(*pressure) +
               "; remove it or write 0");
    if (scene().solver.negative_pressure && pressure != Pressure::mueller)
      fail({"solver"}, "negative_pressure", "negative_pressure = true needs pressure = \"mueller\" in [solver]");
  }

  void check_count() const {
    double count = lattice_points(scene());
    for (const Scene::ParticleFile& particle_file : scene().particle_files)
      count += static_cast<double>(particle_file.particles.positions.size());
    for (const Scene::Rain& rain : scene().rains) count += static_cast<double>(rain.max_particles);
    if (count > static_cast<double>(k_max_particles))
      fail({"fluid"}, "spacing_m",
           "the scene has " + number_text(count) + " particles, rain included; allowed is up to " +
               std::to_string(k_max_particles) + "; raise spacing_m");
  }
};

}  // namespace

void check_scene(const Scene& scene, const Locate& locate) {
  check_ranges(scene, locate);
  Order(scene, locate).check();
}

}  // namespace scene_keys

std::string ratio_problem(const Scene& scene, Pressure pressure) {
  if (pressure != Pressure::dfsph || scene.fluid.support_ratio <= k_largest_dfsph_ratio) return "";
  return "support_ratio = " + scene_keys::number_text(scene.fluid.support_ratio) +
         " is too large for dfsph: particles pair up and the water flies apart; allowed is up to " +
         scene_keys::number_text(k_largest_dfsph_ratio) + ", or another pressure solver";
}

void validate(const Scene& scene) {
  scene_keys::check_scene(scene, [](const scene_keys::SectionName&, const std::string&) { return std::string(); });
}

}  // namespace squall
