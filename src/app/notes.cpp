#include "app/notes.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "app/terminal.h"

namespace squall::app {

namespace {

/// How fast rain alone would raise the level in the container [mm/h]; particles carry dx^3 each.
double rate_mm_h(const Scene& scene, const Scene::Rain& rain) {
  const Eigen::Vector3d size = scene.container_size();
  const double base = size.x() * size.z();
  if (rain.rate_mm_h) return *rain.rate_mm_h * (rain.area_max_m - rain.area_min_m).prod() / base;
  constexpr double k_mm_h_per_m_s = 1000.0 * 3600.0;
  return rain.particles_per_s.value_or(0.0) * scene.particle_volume() / base * k_mm_h_per_m_s;
}

std::string rain_note(const Scene& scene, const Scene::Rain& rain) {
  constexpr double k_cloudburst_mm_h = 100.0;
  const double multiple = rate_mm_h(scene, rain) / k_cloudburst_mm_h;
  const std::string times = multiple < 10.0 ? fmt::format("{:.2g}", multiple) : with_commas(std::llround(multiple));
  // A sphere of volume dx^3 has this diameter.
  const double diameter_mm = 1000.0 * std::cbrt(6.0 / std::numbers::pi) * scene.fluid.spacing_m;
  return fmt::format("rain: {} times 100 mm/h over the container's base; one particle is {:.3g} g, a {:.3g} mm drop",
                     times, 1000.0 * scene.particle_mass(), diameter_mm);
}

}  // namespace

std::vector<std::string> ratio_notes(const Scene& scene) {
  if (scene.fluid.support_ratio <= k_pairing_ratio) return {};
  return {fmt::format(
      "support_ratio = {}: above {} particles come to lie in pairs, so that the water is coarser than its spacing says "
      "and costs more; 2 is what the solvers are made for",
      scene.fluid.support_ratio, k_pairing_ratio)};
}

std::vector<std::string> scene_notes(const Scene& scene) {
  std::vector<std::string> notes = ratio_notes(scene);
  for (const auto& rain : scene.rains) notes.push_back(rain_note(scene, rain));
  return notes;
}

void print_notes(const std::vector<std::string>& notes, bool quiet) {
  if (quiet) return;
  for (const auto& note : notes) std::cerr << "note: " << note << "\n";
}

}  // namespace squall::app
