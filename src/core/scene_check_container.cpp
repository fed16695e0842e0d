#include <string>

#include "core/fill.h"
#include "core/scene_checks.h"

namespace squall::scene_keys {

namespace {

constexpr double k_lost_heights = 10.0;  ///< particles further out than this many container heights are lost
constexpr double k_minimum_jerk_peak = 5.7735026919;  ///< 10/sqrt(3): of a move by 1 m in 1 s, m/s^2
constexpr double k_hardest_move_m_s2 = 1e4;

}  // namespace

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ")";
}

std::string extent_text(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return vector_text(low) + " to " + vector_text(high);
}

std::string short_name(const SectionName& section) { return section.table + " " + std::to_string(section.index); }

Checks::Checks(const Scene& scene, const Locate& locate)
    : scene_(scene), locate_(locate), touch_(length_tolerance(scene)), floor_(scene.container.min_m) {
  // Without a lid the walls reach upward without end; what is higher than this counts as lost.
  ceiling_ = scene.container.max_m;
  if (scene.container.open_top) ceiling_.y() += k_lost_heights * scene.container_size().y();
}

void Checks::check_room(const SectionName& section, const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
  const double spacing = scene_.fluid.spacing_m;
  for (int axis = 0; axis < 3; ++axis)
    if (layers(high[axis] - low[axis], spacing) < 1)
      fail(section, "max_m",
           section.text() + " is " + number_text(high[axis] - low[axis]) + " m thin in " + k_axes[axis] +
               " and has no room for one particle; make it at least spacing_m = " + number_text(spacing) + " thick");
}

void Checks::check_exactly_one(const SectionName& section, const std::string& one, bool has_one,
                               const std::string& other, bool has_other) const {
  if (has_one == has_other)
    fail(section, has_other ? other : "",
         section.text() + " needs exactly one of " + one + " and " + other + "; it has " +
             (has_one ? "both" : "neither"));
}

bool Checks::is_inside(const Eigen::Vector3d& point, const Scene::SolidBox& box) const {
  return ((point - box.min_m).array() > touch_).all() && ((box.max_m - point).array() > touch_).all();
}

void Checks::check_container() const {
  const SectionName section{"container"};
  check_extent(section, scene_.container.min_m, scene_.container.max_m, "max_m");
  check_room(section, scene_.container.min_m, scene_.container.max_m);
}

void Checks::check_motion(const SectionName& section, const Scene::Motion& motion) const {
  check_exactly_one(section, "displacement_m", motion.displacement_m.has_value(), "acceleration_m_s2",
                    motion.acceleration_m_s2.has_value());
  if (!motion.displacement_m) return;
  const double peak = k_minimum_jerk_peak * motion.displacement_m->norm() / (motion.duration_s * motion.duration_s);
  if (peak > k_hardest_move_m_s2)
    fail(section, "duration_s",
         section.text() + " accelerates the container by up to " + number_text(peak) + " m/s^2; allowed is up to " +
             number_text(k_hardest_move_m_s2) + "; lengthen duration_s");
}

void Checks::check_box(const SectionName& section, const Scene::SolidBox& box) const {
  check_extent(section, box.min_m, box.max_m, "max_m");
  for (int axis = 0; axis < 3; ++axis)
    if (box.min_m[axis] >= ceiling_[axis] || box.max_m[axis] <= floor_[axis])
      fail(section, "min_m",
           short_name(section) + " (" + extent_text(box.min_m, box.max_m) + ") lies outside the container (" +
               extent_text(floor_, scene_.container.max_m) + ") in " + k_axes[axis]);
}

}  // namespace squall::scene_keys
