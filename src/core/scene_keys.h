#pragma once

#include <concepts>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "core/scene.h"

/// The keys of a scene file, listed once: reader, printer and validation all walk this list. Private to core.
namespace squall::scene_keys {

/// Whether a key must be there and the legal range of its value (of each component of a vector), in the key's unit.
struct KeyRule {
  bool required = false;
  double low = 0.0;
  double high = 0.0;
};

constexpr KeyRule required(double low, double high) { return {true, low, high}; }
constexpr KeyRule optional(double low, double high) { return {false, low, high}; }
constexpr KeyRule required_text() { return {true, 0.0, 0.0}; }
constexpr KeyRule optional_choice() { return {false, 0.0, 0.0}; }

inline constexpr double k_reach_m = 1e5;      ///< coordinates in the world
inline constexpr double k_travel_m = 1000.0;  ///< of a container
inline constexpr double k_latest_s = 1e6;     ///< points in time
inline constexpr double k_fastest_m_s = 1e3;  ///< start velocities
inline constexpr double k_strongest_m_s2 = 1e3;
inline constexpr double k_gale_m_s = 100.0;
inline constexpr double k_never_s = std::numeric_limits<double>::infinity();
inline constexpr std::int64_t k_max_particles = std::int64_t{1} << 28;  ///< of a scene, rain included

/// A table of the file: [table], or the index-th (from 1) of several [[table]].
struct SectionName {
  std::string table;
  std::size_t index = 0;

  std::string text() const { return index == 0 ? "[" + table + "]" : "[[" + table + "]] " + std::to_string(index); }
};

/// Says where a key was written, as "file:line:column: "; empty for a scene that no file belongs to. An empty key asks
/// for the table itself.
using Locate = std::function<std::string(const SectionName& section, const std::string& key)>;

/// All checks of values and of what belongs together. Throws InputError that begins with what `locate` returns.
void check_scene(const Scene& scene, const Locate& locate);

/// The part of it that looks at one value at a time: every number within its KeyRule, no text empty.
void check_ranges(const Scene& scene, const Locate& locate);

/// Shortest text that reads back to the same double.
std::string number_text(double value);

/// `Any` is Section or const Section: one list serves the reader, which writes, and the others, which do not.
template <class Any, class Section>
concept AnyConst = std::same_as<std::remove_const_t<Any>, Section>;

template <class Visit>
void visit_keys(AnyConst<Scene::Time> auto& time, Visit&& visit) {
  visit("duration_s", time.duration_s, required(1e-3, k_latest_s));
  visit("frame_rate_hz", time.frame_rate_hz, optional(0.1, 1000.0));
}

template <class Visit>
void visit_keys(AnyConst<Scene::Fluid> auto& fluid, Visit&& visit) {
  visit("spacing_m", fluid.spacing_m, required(1e-4, 10.0));
  visit("support_ratio", fluid.support_ratio, optional(1.2, 4.0));
  visit("rest_density_kg_m3", fluid.rest_density_kg_m3, optional(1.0, 1e5));
  visit("viscosity_m2_s", fluid.viscosity_m2_s, optional(0.0, 100.0));
  visit("surface_tension_n_m", fluid.surface_tension_n_m, optional(0.0, 10.0));
}

template <class Visit>
void visit_keys(AnyConst<Scene::Solver> auto& solver, Visit&& visit) {
  visit("pressure", solver.pressure, optional_choice());
  visit("density_tolerance", solver.density_tolerance, optional(1e-7, 0.5));
  visit("divergence_tolerance", solver.divergence_tolerance, optional(1e-7, 0.5));
  visit("max_iterations", solver.max_iterations, optional(1, 10000));
  visit("dt_max_s", solver.dt_max_s, optional(1e-7, 1.0));
  visit("cfl", solver.cfl, optional(1e-3, 100.0));
  visit("xsph", solver.xsph, optional(0.0, 1.0));
  visit("stiffness_m2_s2", solver.stiffness_m2_s2, optional(1e-3, 1e8));
  visit("speed_of_sound_m_s", solver.speed_of_sound_m_s, optional(1e-2, 1e4));
  visit("artificial_viscosity", solver.artificial_viscosity, optional(0.0, 10.0));
  visit("negative_pressure", solver.negative_pressure, optional_choice());
}

/// [gravity] has one key, so its vector stands for the section.
template <class Visit>
void visit_keys(AnyConst<Eigen::Vector3d> auto& gravity, Visit&& visit) {
  visit("vector_m_s2", gravity, optional(-k_strongest_m_s2, k_strongest_m_s2));
}

template <class Visit>
void visit_keys(AnyConst<Scene::Container> auto& container, Visit&& visit) {
  visit("min_m", container.min_m, required(-k_reach_m, k_reach_m));
  visit("max_m", container.max_m, required(-k_reach_m, k_reach_m));
  visit("open_top", container.open_top, optional_choice());
}

template <class Visit>
void visit_keys(AnyConst<Scene::Motion> auto& motion, Visit&& visit) {
  visit("start_s", motion.start_s, required(0.0, k_latest_s));
  visit("duration_s", motion.duration_s, required(1e-3, k_latest_s));
  visit("displacement_m", motion.displacement_m, optional(-k_travel_m, k_travel_m));
  visit("acceleration_m_s2", motion.acceleration_m_s2, optional(-k_strongest_m_s2, k_strongest_m_s2));
}

template <class Visit>
void visit_keys(AnyConst<Scene::SolidBox> auto& box, Visit&& visit) {
  visit("min_m", box.min_m, required(-k_reach_m, k_reach_m));
  visit("max_m", box.max_m, required(-k_reach_m, k_reach_m));
  visit("until_s", box.until_s, optional(0.0, k_latest_s));
}

template <class Visit>
void visit_keys(AnyConst<Scene::Block> auto& block, Visit&& visit) {
  visit("min_m", block.min_m, required(-k_reach_m, k_reach_m));
  visit("max_m", block.max_m, required(-k_reach_m, k_reach_m));
  visit("velocity_m_s", block.velocity_m_s, optional(-k_fastest_m_s, k_fastest_m_s));
  visit("held_until_s", block.held_until_s, optional(0.0, k_latest_s));
}

template <class Visit>
void visit_keys(AnyConst<Scene::ParticleFile> auto& particle_file, Visit&& visit) {
  visit("file", particle_file.file, required_text());
}

template <class Visit>
void visit_keys(AnyConst<Scene::Rain> auto& rain, Visit&& visit) {
  visit("rate_mm_h", rain.rate_mm_h, optional(0.0, 1e9));
  visit("particles_per_s", rain.particles_per_s, optional(0.0, 1e9));
  visit("drop_diameter_mm", rain.drop_diameter_mm, optional(0.5, 8.0));
  visit("area_min_m", rain.area_min_m, required(-k_reach_m, k_reach_m));
  visit("area_max_m", rain.area_max_m, required(-k_reach_m, k_reach_m));
  visit("height_m", rain.height_m, required(-k_reach_m, k_reach_m));
  visit("wind_m_s", rain.wind_m_s, optional(-k_gale_m_s, k_gale_m_s));
  visit("start_s", rain.start_s, optional(0.0, k_latest_s));
  visit("stop_s", rain.stop_s, optional(0.0, k_never_s));
  visit("max_particles", rain.max_particles, required(0, static_cast<double>(k_max_particles)));
}

template <class Visit>
void visit_keys(AnyConst<Scene::Gauge> auto& gauge, Visit&& visit) {
  visit("name", gauge.name, required_text());
  visit("position_m", gauge.position_m, required(-k_reach_m, k_reach_m));
  visit("kind", gauge.kind, required_text());
}

template <class List, class Visit>
void visit_list(const char* table, List& list, Visit& visit) {
  for (std::size_t i = 0; i < list.size(); ++i) visit(SectionName{table, i + 1}, list[i]);
}

/// Every section of a scene in the order of the printed file: visit(name, section).
template <class Visit>
void visit_sections(AnyConst<Scene> auto& scene, Visit&& visit) {
  visit(SectionName{"time"}, scene.time);
  visit(SectionName{"fluid"}, scene.fluid);
  visit(SectionName{"solver"}, scene.solver);
  visit(SectionName{"gravity"}, scene.gravity_m_s2);
  visit(SectionName{"container"}, scene.container);
  visit_list("container.motion", scene.container.motions, visit);
  visit_list("box", scene.boxes, visit);
  visit_list("block", scene.blocks, visit);
  visit_list("particles", scene.particle_files, visit);
  visit_list("rain", scene.rains, visit);
  visit_list("gauge", scene.gauges, visit);
}

}  // namespace squall::scene_keys
