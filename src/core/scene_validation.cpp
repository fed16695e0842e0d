#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/fill.h"
#include "core/frame_plan.h"
#include "core/rain.h"
#include "core/same_place.h"
#include "core/scene.h"
#include "core/scene_keys.h"

namespace squall {
namespace scene_keys {
namespace {

constexpr const char* k_axes[] = {"x", "y", "z"};
constexpr double k_lost_heights = 10.0;  ///< particles further out than this many container heights are lost
constexpr double k_minimum_jerk_peak = 5.7735026919;  ///< 10/sqrt(3): of a move by 1 m in 1 s, m/s^2
constexpr double k_hardest_move_m_s2 = 1e4;

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ")";
}

std::string extent_text(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return vector_text(low) + " to " + vector_text(high);
}

/// What a list's entry is called in a sentence: "block 2".
std::string short_name(const SectionName& section) { return section.table + " " + std::to_string(section.index); }

class Checker {
 public:
  Checker(const Scene& scene, const Locate& locate)
      : scene_(scene), locate_(locate), touch_(length_tolerance(scene)), floor_(scene.container.min_m) {
    // Without a lid the walls reach upward without end; what is higher than this counts as lost.
    ceiling_ = scene.container.max_m;
    if (scene.container.open_top) ceiling_.y() += k_lost_heights * scene.container_size().y();
  }

  void check() const {
    check_ranges(scene_, locate_);
    check_version();
    check_time();
    check_solver();
    check_container();
    for_each("container.motion", scene_.container.motions, &Checker::check_motion);
    for_each("box", scene_.boxes, &Checker::check_box);
    for_each("block", scene_.blocks, &Checker::check_block);
    check_blocks_apart();
    for_each("particles", scene_.particle_files, &Checker::check_particles);
    for_each("rain", scene_.rains, &Checker::check_rain);
    for_each("gauge", scene_.gauges, &Checker::check_gauge);
    check_count();
    check_places();
  }

 private:
  template <class Entry>
  void for_each(const char* table, const std::vector<Entry>& list,
                void (Checker::*check_one)(const SectionName&, const Entry&) const) const {
    for (std::size_t i = 0; i < list.size(); ++i) (this->*check_one)(SectionName{table, i + 1}, list[i]);
  }

  [[noreturn]] void fail(const SectionName& section, const std::string& key, const std::string& what) const {
    throw InputError(locate_(section, key) + what);
  }

  void check_version() const {
    if (scene_.fluid.surface_tension_n_m)
      fail({"fluid"}, "surface_tension_n_m", "surface tension is not in this version; remove surface_tension_n_m");
  }

  void check_time() const {
    const double needed = 1.0 / (scene_.time.frame_rate_hz * scene_.solver.dt_max_s);
    if (needed > k_max_substeps)
      fail({"time"}, "frame_rate_hz",
           "frame_rate_hz = " + number_text(scene_.time.frame_rate_hz) + " needs " + number_text(std::ceil(needed)) +
               " sub-steps of dt_max_s = " + number_text(scene_.solver.dt_max_s) + " per frame; allowed are " +
               std::to_string(k_max_substeps) + "; raise frame_rate_hz or dt_max_s");
  }

  void check_solver() const {
    const auto pressure = scene_.solver.pressure;
    if (scene_.solver.xsph > 0.0 && pressure && *pressure != Pressure::dfsph)
      fail({"solver"}, "xsph",
           "xsph = " + number_text(scene_.solver.xsph) + " needs pressure dfsph, not " + to_string(*pressure) +
               "; remove it or write 0");
    if (scene_.solver.negative_pressure && pressure != Pressure::mueller)
      fail({"solver"}, "negative_pressure", "negative_pressure = true needs pressure = \"mueller\" in [solver]");
  }

  /// min < max on every axis: x, y, z, or x and z for the areas of rain.
  template <class Vector>
  void check_extent(const SectionName& section, const Vector& low, const Vector& high, const char* max_key) const {
    for (int axis = 0; axis < low.size(); ++axis)
      if (!(low[axis] < high[axis]))
        fail(section, max_key,
             section.text() + " is empty: its min " + number_text(low[axis]) + " is not below its max " +
                 number_text(high[axis]) + " in " + k_axes[low.size() == 2 ? 2 * axis : axis]);
  }

  void check_room(const SectionName& section, const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    const double spacing = scene_.fluid.spacing_m;
    for (int axis = 0; axis < 3; ++axis)
      if (layers(high[axis] - low[axis], spacing) < 1)
        fail(section, "max_m",
             section.text() + " is " + number_text(high[axis] - low[axis]) + " m thin in " + k_axes[axis] +
                 " and has no room for one particle; make it at least spacing_m = " + number_text(spacing) + " thick");
  }

  void check_container() const {
    const SectionName section{"container"};
    check_extent(section, scene_.container.min_m, scene_.container.max_m, "max_m");
    check_room(section, scene_.container.min_m, scene_.container.max_m);
  }

  void check_motion(const SectionName& section, const Scene::Motion& motion) const {
    check_exactly_one(section, "displacement_m", motion.displacement_m.has_value(), "acceleration_m_s2",
                      motion.acceleration_m_s2.has_value());
    if (!motion.displacement_m) return;
    const double peak = k_minimum_jerk_peak * motion.displacement_m->norm() / (motion.duration_s * motion.duration_s);
    if (peak > k_hardest_move_m_s2)
      fail(section, "duration_s",
           section.text() + " accelerates the container by up to " + number_text(peak) + " m/s^2; allowed is up to " +
               number_text(k_hardest_move_m_s2) + "; lengthen duration_s");
  }

  void check_exactly_one(const SectionName& section, const std::string& one, bool has_one, const std::string& other,
                         bool has_other) const {
    if (has_one == has_other)
      fail(section, has_other ? other : "",
           section.text() + " needs exactly one of " + one + " and " + other + "; it has " +
               (has_one ? "both" : "neither"));
  }

  void check_box(const SectionName& section, const Scene::SolidBox& box) const {
    check_extent(section, box.min_m, box.max_m, "max_m");
    for (int axis = 0; axis < 3; ++axis)
      if (box.min_m[axis] >= ceiling_[axis] || box.max_m[axis] <= floor_[axis])
        fail(section, "min_m",
             short_name(section) + " (" + extent_text(box.min_m, box.max_m) + ") lies outside the container (" +
                 extent_text(floor_, scene_.container.max_m) + ") in " + k_axes[axis]);
  }

  void check_block(const SectionName& section, const Scene::Block& block) const {
    check_extent(section, block.min_m, block.max_m, "max_m");
    check_room(section, block.min_m, block.max_m);
    for (int axis = 0; axis < 3; ++axis) {
      const bool too_low = block.min_m[axis] < floor_[axis] - touch_;
      if (too_low || block.max_m[axis] > ceiling_[axis] + touch_)
        fail(section, too_low ? "min_m" : "max_m",
             short_name(section) + " (" + extent_text(block.min_m, block.max_m) + ") reaches outside the container (" +
                 extent_text(floor_, scene_.container.max_m) + ") in " + k_axes[axis]);
    }
  }

  void check_blocks_apart() const {
    const BlockPair pair = overlapping_blocks(scene_);
    if (pair.first == pair.second) return;
    const Scene::Block& first = scene_.blocks[pair.first];
    fail({"block", pair.second + 1}, "min_m",
         "block " + std::to_string(pair.second + 1) + " overlaps block " + std::to_string(pair.first + 1) + " (" +
             extent_text(first.min_m, first.max_m) + "); move them apart");
  }

  void check_particles(const SectionName& section, const Scene::ParticleFile& particle_file) const {
    const Particles& particles = particle_file.particles;
    if (particles.positions.size() != particles.velocities.size())
      fail(section, "file",
           "'" + particle_file.file + "' has " + std::to_string(particles.positions.size()) + " positions but " +
               std::to_string(particles.velocities.size()) + " velocities");
    for (std::size_t i = 0; i < particles.positions.size(); ++i) {
      const std::string fault = particle_fault(particles.positions[i], particles.velocities[i]);
      if (!fault.empty())
        fail(section, "file", "particle " + std::to_string(i + 1) + " of '" + particle_file.file + "' " + fault);
    }
  }

  /// Empty if the particle is fine. Written so that NaN is a fault.
  std::string particle_fault(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) const {
    const Eigen::Vector3d skin = Eigen::Vector3d::Constant(touch_);
    if (!((position - floor_ + skin).array() >= 0.0).all() || !((ceiling_ + skin - position).array() >= 0.0).all())
      return "at " + vector_text(position) + " lies outside the container (" +
             extent_text(floor_, scene_.container.max_m) + ")";
    if (!(velocity.cwiseAbs().array() <= k_fastest_m_s).all())
      return "has velocity " + vector_text(velocity) + " m/s; allowed is up to " + number_text(k_fastest_m_s) +
             " in each direction";
    for (std::size_t b = 0; b < scene_.boxes.size(); ++b)
      if (((position - scene_.boxes[b].min_m).array() > touch_).all() &&
          ((scene_.boxes[b].max_m - position).array() > touch_).all())
        return "at " + vector_text(position) + " lies inside box " + std::to_string(b + 1);
    return "";
  }

  void check_rain(const SectionName& section, const Scene::Rain& rain) const {
    check_exactly_one(section, "rate_mm_h", rain.rate_mm_h.has_value(), "particles_per_s",
                      rain.particles_per_s.has_value());
    if (!scene_.container.open_top)
      fail(section, "",
           section.text() + " cannot fall into a container with a lid; set open_top = true in [container]");
    check_extent(section, rain.area_min_m, rain.area_max_m, "area_max_m");
    check_rain_area(section, rain);
    const double top = scene_.container.max_m.y();
    // Drops are released along one frame's fall above the height.
    const double highest = ceiling_.y() - terminal_speed(rain.drop_diameter_mm) / scene_.time.frame_rate_hz;
    if (rain.height_m < top || rain.height_m > highest)
      fail(section, "height_m",
           "height_m = " + number_text(rain.height_m) + " in " + section.text() +
               " is out of range; allowed is the container's top, " + number_text(top) + ", to " +
               number_text(highest) + " (ten container heights above, less a drop's fall in one frame)");
    if (!(rain.start_s < rain.stop_s))
      fail(section, "stop_s",
           "stop_s = " + number_text(rain.stop_s) + " in " + section.text() +
               " is not after start_s = " + number_text(rain.start_s));
    check_same_air(section, rain);
  }

  /// Lone drops feel one wind and one drag, whichever rain they fell from.
  void check_same_air(const SectionName& section, const Scene::Rain& rain) const {
    const Scene::Rain& first = scene_.rains.front();
    if (rain.wind_m_s != first.wind_m_s)
      fail(section, "wind_m_s", section.text() + " must have the wind_m_s of [[rain]] 1: one wind blows over a scene");
    if (rain.drop_diameter_mm != first.drop_diameter_mm)
      fail(section, "drop_diameter_mm",
           section.text() + " must have the drop_diameter_mm of [[rain]] 1: drops of a scene feel one drag");
  }

  void check_rain_area(const SectionName& section, const Scene::Rain& rain) const {
    for (int axis = 0; axis < 2; ++axis) {
      const int side = 2 * axis;
      const double low = floor_[side], high = scene_.container.max_m[side];
      const bool too_low = rain.area_min_m[axis] < low - touch_;
      if (too_low || rain.area_max_m[axis] > high + touch_)
        fail(section, too_low ? "area_min_m" : "area_max_m",
             "the area of " + section.text() + " reaches outside the container in " + k_axes[side] + ": " +
                 number_text(rain.area_min_m[axis]) + " to " + number_text(rain.area_max_m[axis]) + "; allowed is " +
                 number_text(low) + " to " + number_text(high));
    }
  }

  void check_gauge(const SectionName& section, const Scene::Gauge& gauge) const {
    check_gauge_name(section, gauge);
    if (gauge.kind != "level" && gauge.kind != "pressure" && gauge.kind != "velocity")
      fail(section, "kind",
           "kind = '" + gauge.kind + "' in " + section.text() + " is unknown; there are level, pressure, velocity");
    const Eigen::Vector3d& at = gauge.position_m;
    for (int axis = 0; axis < 3; ++axis)
      if (!(at[axis] >= floor_[axis] - touch_) || !(at[axis] <= ceiling_[axis] + touch_))
        fail(section, "position_m",
             "gauge '" + gauge.name + "' at " + vector_text(at) + " lies outside the container (" +
                 extent_text(floor_, scene_.container.max_m) + ") in " + k_axes[axis]);
    if (gauge.kind == "level") return;
    for (std::size_t b = 0; b < scene_.boxes.size(); ++b)
      if (!scene_.boxes[b].until_s && ((at - scene_.boxes[b].min_m).array() > touch_).all() &&
          ((scene_.boxes[b].max_m - at).array() > touch_).all())
        fail(section, "position_m",
             "gauge '" + gauge.name + "' at " + vector_text(at) + " lies inside box " + std::to_string(b + 1) +
                 ", where no water comes; move it to a face");
  }

  /// A name is a column of gauges.csv, and a quantity beside those that every scene has.
  void check_gauge_name(const SectionName& section, const Scene::Gauge& gauge) const {
    for (const char c : gauge.name)
      if (static_cast<unsigned char>(c) < 0x20 || c == ',' || c == '"')
        fail(section, "name",
             "the name of " + section.text() +
                 " holds a comma, a quote or a control character; it is a column of a "
                 "CSV file");
    for (std::size_t i = 0; i + 1 < section.index; ++i)
      if (scene_.gauges[i].name == gauge.name)
        fail(section, "name",
             "gauges " + std::to_string(i + 1) + " and " + std::to_string(section.index) + " are both called '" +
                 gauge.name + "'; give each its own name");
    const auto columns = columns_of(gauge);
    for (const auto& column : columns)
      if (column == "time_s")
        fail(section, "name", "a gauge cannot be called time_s; that is the first column of gauges.csv");
    for (std::size_t i = 0; i + 1 < section.index; ++i)
      for (const auto& other : columns_of(scene_.gauges[i]))
        if (std::find(columns.begin(), columns.end(), other) != columns.end())
          fail(section, "name",
               "gauges " + std::to_string(i + 1) + " ('" + scene_.gauges[i].name + "') and " +
                   std::to_string(section.index) + " ('" + gauge.name + "') both have a column '" + other +
                   "' (a velocity has three, with _x, _y and _z); give one of them another name");
  }

  static std::vector<std::string> columns_of(const Scene::Gauge& gauge) {
    if (gauge.kind != "velocity") return {gauge.name};
    return {gauge.name + "_x", gauge.name + "_y", gauge.name + "_z"};
  }

  void check_count() const {
    double count = lattice_points(scene_);
    for (const Scene::ParticleFile& particle_file : scene_.particle_files)
      count += static_cast<double>(particle_file.particles.positions.size());
    for (const Scene::Rain& rain : scene_.rains) count += static_cast<double>(rain.max_particles);
    if (count > static_cast<double>(k_max_particles))
      fail({"fluid"}, "spacing_m",
           "the scene has " + number_text(count) + " particles, rain included; allowed is up to " +
               std::to_string(k_max_particles) + "; raise spacing_m");
  }

  /// Blocks are lattices apart from each other; only what comes from a file can lie twice in one place.
  void check_places() const {
    if (scene_.particle_files.empty()) return;
    const auto twins = same_place(initial_particles(scene_).positions);
    if (!twins) return;
    const Origin second = origin_of(twins->second);
    fail({"particles", second.file}, "file",
         second.text + " lies in the same place as " + origin_of(twins->first).text +
             ": nothing could ever push them apart; move or remove one of them");
  }

  struct Origin {
    std::size_t file;  ///< counted from 1; 0: a block
    std::string text;
  };

  /// Of the particle with this index at the start.
  Origin origin_of(std::size_t index) const {
    for (const Scene::Block& block : scene_.blocks) {
      const auto count = static_cast<std::size_t>(block_points(scene_, block));
      if (index < count) return {0, "a particle of block " + std::to_string(1 + (&block - scene_.blocks.data()))};
      index -= count;
    }
    std::size_t file = 0;
    while (index >= scene_.particle_files[file].particles.size())
      index -= scene_.particle_files[file++].particles.size();
    const Particles& particles = scene_.particle_files[file].particles;
    return {file + 1, "particle " + std::to_string(index + 1) + " of '" + scene_.particle_files[file].file + "' at " +
                          vector_text(particles.positions[index])};
  }

  const Scene& scene_;
  const Locate& locate_;
  double touch_;  ///< lengths that differ by less are the same [m]
  Eigen::Vector3d floor_, ceiling_;
};

}  // namespace

void check_scene(const Scene& scene, const Locate& locate) { Checker(scene, locate).check(); }

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
