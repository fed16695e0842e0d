#pragma once

#include <string>

#include "core/errors.h"
#include "core/scene.h"
#include "core/scene_keys.h"

/// Checks of a scene that look at more than one value, a file for the water, one for what holds it, one for gauges.
/// Private to core.
namespace squall::scene_keys {

/// What every check needs: the scene, its places in the file, and what the container encloses.
class Checks {
 public:
  Checks(const Scene& scene, const Locate& locate);

  void check_container() const;
  void check_motion(const SectionName& section, const Scene::Motion& motion) const;
  void check_box(const SectionName& section, const Scene::SolidBox& box) const;
  void check_block(const SectionName& section, const Scene::Block& block) const;
  void check_blocks_apart() const;
  void check_particles(const SectionName& section, const Scene::ParticleFile& particle_file) const;
  /// Blocks are lattices apart from each other; only what comes from a file can lie twice in one place.
  void check_places() const;
  void check_rain(const SectionName& section, const Scene::Rain& rain) const;
  void check_gauge(const SectionName& section, const Scene::Gauge& gauge) const;

 protected:
  [[noreturn]] void fail(const SectionName& section, const std::string& key, const std::string& what) const {
    throw InputError(locate_(section, key) + what);
  }
  const Scene& scene() const { return scene_; }

 private:
  /// min < max on every axis: x, y, z, or x and z for the areas of rain.
  template <class Vector>
  void check_extent(const SectionName& section, const Vector& low, const Vector& high, const char* max_key) const;
  void check_room(const SectionName& section, const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;
  void check_exactly_one(const SectionName& section, const std::string& one, bool has_one, const std::string& other,
                         bool has_other) const;
  /// Empty if the particle is fine.
  std::string particle_fault(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) const;
  struct Origin {
    std::size_t file;  ///< counted from 1; 0: a block
    std::string text;
  };
  /// Of the particle with this index at the start.
  Origin origin_of(std::size_t index) const;
  void check_rain_area(const SectionName& section, const Scene::Rain& rain) const;
  void check_same_air(const SectionName& section, const Scene::Rain& rain) const;
  void check_gauge_name(const SectionName& section, const Scene::Gauge& gauge) const;
  /// Inside it by more than rounding.
  bool is_inside(const Eigen::Vector3d& point, const Scene::SolidBox& box) const;

  const Scene& scene_;
  const Locate& locate_;
  double touch_;  ///< lengths that differ by less are the same [m]
  Eigen::Vector3d floor_, ceiling_;
};

inline constexpr const char* k_axes[] = {"x", "y", "z"};

std::string vector_text(const Eigen::Vector3d& v);
/// "(0, 0, 0) to (1, 2, 1)".
std::string extent_text(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// What a list's entry is called in a sentence: "block 2".
std::string short_name(const SectionName& section);

template <class Vector>
void Checks::check_extent(const SectionName& section, const Vector& low, const Vector& high,
                          const char* max_key) const {
  for (int axis = 0; axis < low.size(); ++axis)
    if (!(low[axis] < high[axis]))
      fail(section, max_key,
           section.text() + " is empty: its min " + number_text(low[axis]) + " is not below its max " +
               number_text(high[axis]) + " in " + k_axes[low.size() == 2 ? 2 * axis : axis]);
}

}  // namespace squall::scene_keys
