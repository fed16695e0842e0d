#include <cstddef>
#include <string>

#include "core/fill.h"
#include "core/rain.h"
#include "core/same_place.h"
#include "core/scene_checks.h"

namespace squall::scene_keys {

void Checks::check_block(const SectionName& section, const Scene::Block& block) const {
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

void Checks::check_blocks_apart() const {
  const BlockPair pair = overlapping_blocks(scene_);
  if (pair.first == pair.second) return;
  const Scene::Block& first = scene_.blocks[pair.first];
  fail({"block", pair.second + 1}, "min_m",
       "block " + std::to_string(pair.second + 1) + " overlaps block " + std::to_string(pair.first + 1) + " (" +
           extent_text(first.min_m, first.max_m) + "); move them apart");
}

void Checks::check_particles(const SectionName& section, const Scene::ParticleFile& particle_file) const {
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

/// Written so that NaN is a fault.
std::string Checks::particle_fault(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) const {
  const Eigen::Vector3d skin = Eigen::Vector3d::Constant(touch_);
  if (!((position - floor_ + skin).array() >= 0.0).all() || !((ceiling_ + skin - position).array() >= 0.0).all())
    return "at " + vector_text(position) + " lies outside the container (" +
           extent_text(floor_, scene_.container.max_m) + ")";
  if (!(velocity.cwiseAbs().array() <= k_fastest_m_s).all())
    return "has velocity " + vector_text(velocity) + " m/s; allowed is up to " + number_text(k_fastest_m_s) +
           " in each direction";
  for (std::size_t b = 0; b < scene_.boxes.size(); ++b)
    if (is_inside(position, scene_.boxes[b]))
      return "at " + vector_text(position) + " lies inside box " + std::to_string(b + 1);
  return "";
}

void Checks::check_places() const {
  if (scene_.particle_files.empty()) return;
  std::int64_t in_blocks = 0;
  for (const Scene::Block& block : scene_.blocks) in_blocks += block_points(scene_, block);
  const auto twins = same_place(initial_particles(scene_).positions, static_cast<std::size_t>(in_blocks));
  if (!twins) return;
  const Origin second = origin_of(twins->second);
  fail({"particles", second.file}, "file",
       second.text + " lies in the same place as " + origin_of(twins->first).text +
           ": nothing could ever push them apart; move or remove one of them");
}

Checks::Origin Checks::origin_of(std::size_t index) const {
  for (std::size_t b = 0; b < scene_.blocks.size(); ++b) {
    const auto count = static_cast<std::size_t>(block_points(scene_, scene_.blocks[b]));
    if (index < count) return {0, "a particle of block " + std::to_string(b + 1)};
    index -= count;
  }
  std::size_t file = 0;
  while (index >= scene_.particle_files[file].particles.positions.size())
    index -= scene_.particle_files[file++].particles.positions.size();
  const Scene::ParticleFile& from = scene_.particle_files[file];
  return {file + 1, "particle " + std::to_string(index + 1) + " of '" + from.file + "' at " +
                        vector_text(from.particles.positions[index])};
}

void Checks::check_rain(const SectionName& section, const Scene::Rain& rain) const {
  check_exactly_one(section, "rate_mm_h", rain.rate_mm_h.has_value(), "particles_per_s",
                    rain.particles_per_s.has_value());
  if (!scene_.container.open_top)
    fail(section, "", section.text() + " cannot fall into a container with a lid; set open_top = true in [container]");
  check_extent(section, rain.area_min_m, rain.area_max_m, "area_max_m");
  check_rain_area(section, rain);
  const double top = scene_.container.max_m.y();
  // Drops are released along one frame's fall above the height.
  const double highest = ceiling_.y() - terminal_speed(rain.drop_diameter_mm) / scene_.time.frame_rate_hz;
  if (rain.height_m < top || rain.height_m > highest)
    fail(section, "height_m",
         "height_m = " + number_text(rain.height_m) + " in " + section.text() +
             " is out of range; allowed is the container's top, " + number_text(top) + ", to " + number_text(highest) +
             " (ten container heights above, less a drop's fall in one frame)");
  if (!(rain.start_s < rain.stop_s))
    fail(section, "stop_s",
         "stop_s = " + number_text(rain.stop_s) + " in " + section.text() +
             " is not after start_s = " + number_text(rain.start_s));
  check_same_air(section, rain);
}

/// Lone drops feel one wind and one drag, whichever rain they fell from.
void Checks::check_same_air(const SectionName& section, const Scene::Rain& rain) const {
  const Scene::Rain& first = scene_.rains.front();
  if (rain.wind_m_s != first.wind_m_s)
    fail(section, "wind_m_s", section.text() + " must have the wind_m_s of [[rain]] 1: one wind blows over a scene");
  if (rain.drop_diameter_mm != first.drop_diameter_mm)
    fail(section, "drop_diameter_mm",
         section.text() + " must have the drop_diameter_mm of [[rain]] 1: drops of a scene feel one drag");
}

void Checks::check_rain_area(const SectionName& section, const Scene::Rain& rain) const {
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

}  // namespace squall::scene_keys
