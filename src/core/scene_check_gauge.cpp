#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/scene_checks.h"

namespace squall::scene_keys {

namespace {

std::vector<std::string> columns_of(const Scene::Gauge& gauge) {
  if (gauge.kind != "velocity") return {gauge.name};
  return {gauge.name + "_x", gauge.name + "_y", gauge.name + "_z"};
}

}  // namespace

void Checks::check_gauge(const SectionName& section, const Scene::Gauge& gauge) const {
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
    if (!scene_.boxes[b].until_s && is_inside(at, scene_.boxes[b]))
      fail(section, "position_m",
           "gauge '" + gauge.name + "' at " + vector_text(at) + " lies inside box " + std::to_string(b + 1) +
               ", where no water comes; move it to a face");
}

/// A name is a column of gauges.csv, and a quantity beside those that every scene has.
void Checks::check_gauge_name(const SectionName& section, const Scene::Gauge& gauge) const {
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

}  // namespace squall::scene_keys
