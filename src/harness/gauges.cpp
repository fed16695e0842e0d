#include "harness/gauges.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "harness/present.h"
#include "sph_formulas.h"

namespace squall::harness {

namespace {

/// Kernel weight of a point as seen from a place, without its scale.
double weight(const WaterPoint& point, const Eigen::Vector3d& at, double support) {
  const double q = (point.position - at).norm() / support;
  return cubic_value(std::max(0.0, 1.0 - q), std::max(0.0, 1.0 - 2.0 * q));
}

/// Kernel-weighted mean (Shepard) of value(point); NaN without a point within H.
template <class Value>
GaugeReading mean_at(const std::vector<WaterPoint>& points, const Eigen::Vector3d& at, double support, Value value) {
  double sum = 0.0, weights = 0.0;
  for (const auto& point : points) {
    const double w = weight(point, at, support);
    sum += w * value(point);
    weights += w;
  }
  if (weights > 0.0) return {sum / weights, true};
  return {std::numeric_limits<double>::quiet_NaN(), false};
}

/// Positions joined to the first ones by steps shorter than H; the first ones lie less than H above `base`.
double top_of_connected(std::vector<Eigen::Vector3d> column, double base, double support) {
  double top = base;
  std::vector<Eigen::Vector3d> reached;
  const auto move_if = [&](auto condition) {
    const auto rest = std::partition(column.begin(), column.end(), [&](const auto& x) { return !condition(x); });
    reached.insert(reached.end(), rest, column.end());
    column.erase(rest, column.end());
  };
  move_if([&](const auto& x) { return x.y() < base + support; });
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const Eigen::Vector3d from = reached[next];
    top = std::max(top, from.y());
    move_if([&](const auto& x) { return (x - from).squaredNorm() < support * support; });
  }
  return reached.empty() ? base : top;
}

/// What stands under (x, z): the floor, or boxes that are stacked on it.
double base_under(const Scene& scene, double time_s, const Eigen::Vector3d& at) {
  double base = 0.0;
  for (std::size_t pass = 0; pass < scene.boxes.size(); ++pass)
    for (const auto& box : scene.boxes) {
      if (box.until_s.value_or(std::numeric_limits<double>::infinity()) <= time_s) continue;
      const Eigen::Vector3d low = box.min_m - scene.container.min_m, high = box.max_m - scene.container.min_m;
      const bool covers = at.x() >= low.x() && at.x() <= high.x() && at.z() >= low.z() && at.z() <= high.z();
      if (covers && low.y() < base + scene.support_radius()) base = std::max(base, high.y());
    }
  return base;
}

}  // namespace

Gauges::Gauges(const Scene& scene, Pressure pressure) : scene_(scene), field_(scene, pressure) {
  for (const auto& gauge : scene.gauges) {
    if (gauge.kind != "level") places_.push_back(gauge.position_m - scene.container.min_m);
    if (gauge.kind == "velocity")
      for (const char* axis : {"_x", "_y", "_z"}) columns_.push_back({gauge.name + axis, "m/s", true, false});
    else if (gauge.kind == "pressure")
      columns_.push_back({gauge.name, "Pa", false, true});
    else
      columns_.push_back({gauge.name, "m", false, false});
  }
}

bool Gauges::has_pressure() const {
  return std::any_of(columns_.begin(), columns_.end(), [](const auto& column) { return column.is_pressure; });
}

std::vector<double> Gauges::read(const State& state) const {
  std::vector<double> values;
  for (const auto& reading : readings(state)) values.push_back(reading.value);
  return values;
}

std::vector<GaugeReading> Gauges::readings(const State& state) const {
  const auto points = field_.around(state, places_, scene_.support_radius());
  std::vector<GaugeReading> values;
  for (const auto& gauge : scene_.gauges) {
    const Eigen::Vector3d at = gauge.position_m - scene_.container.min_m;
    if (gauge.kind == "level") values.push_back(level(state, at));
    if (gauge.kind == "pressure") values.push_back(pressure(state, points, at));
    if (gauge.kind == "velocity")
      for (int axis = 0; axis < 3; ++axis)
        values.push_back(
            mean_at(points, at, scene_.support_radius(), [axis](const auto& point) { return point.velocity[axis]; }));
  }
  return values;
}

GaugeReading Gauges::level(const State& state, const Eigen::Vector3d& at) const {
  const double time_s = time_of(scene_, state), support = scene_.support_radius();
  const Present present(scene_, time_s);
  const double base = base_under(scene_, time_s, at);
  std::vector<Eigen::Vector3d> column;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const Eigen::Vector3d& x = state.particles.positions[i];
    const double across = std::hypot(x.x() - at.x(), x.z() - at.z());
    if (across < support && x.y() >= base && present.is_free(state.particles, i)) column.push_back(x);
  }
  const double top = top_of_connected(std::move(column), base, support);
  if (top > base) return {top + 0.5 * scene_.fluid.spacing_m, true};
  return {base, false};
}

GaugeReading Gauges::pressure(const State& state, const std::vector<WaterPoint>& points,
                              const Eigen::Vector3d& at) const {
  Face face;
  if (nearest_face(time_of(scene_, state), at, face)) return wall_pressure(face, points, at);
  const auto mean = mean_at(points, at, scene_.support_radius(), [](const auto& point) { return point.pressure_pa; });
  return mean.in_water ? mean : GaugeReading{};
}

GaugeReading Gauges::wall_pressure(const Face& face, const std::vector<WaterPoint>& points,
                                   const Eigen::Vector3d& at) const {
  const double dx = scene_.fluid.spacing_m;
  double area = 1.0, force = 0.0;
  bool in_water = false;
  Eigen::Vector3d low = at, high = at;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == face.axis) continue;
    low[axis] = std::max(at[axis] - dx, face.low[axis]);
    high[axis] = std::min(at[axis] + dx, face.high[axis]);
    area *= high[axis] - low[axis];
  }
  for (const auto& point : points) {
    bool inside = face.sign * (point.position[face.axis] - face.plane) > -dx;
    inside = inside && face.sign * (point.position[face.axis] - face.plane) < scene_.support_radius();
    for (int axis = 0; axis < 3; ++axis)
      if (axis != face.axis) inside = inside && point.position[axis] >= low[axis] && point.position[axis] < high[axis];
    if (!inside) continue;
    in_water = true;
    force += scene_.particle_mass() * face.sign * point.wall_acceleration[face.axis];
  }
  return {force / area, in_water};
}

bool Gauges::nearest_face(double time_s, const Eigen::Vector3d& at, Face& nearest) const {
  const double touch = 1e-6 * scene_.fluid.spacing_m;
  double least = scene_.support_radius();
  bool found = false;
  for (const Face& face : faces(time_s)) {
    const double distance = face.sign * (at[face.axis] - face.plane);
    bool faces_it = distance >= -touch && distance < least;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != face.axis)
        faces_it = faces_it && at[axis] >= face.low[axis] - touch && at[axis] <= face.high[axis] + touch;
    if (!faces_it) continue;
    nearest = face;
    least = distance;
    found = true;
  }
  return found;
}

std::vector<Gauges::Face> Gauges::faces(double time_s) const {
  const Eigen::Vector3d size = scene_.container_size();
  Eigen::Vector3d high = size;
  if (scene_.container.open_top) high.y() = std::numeric_limits<double>::infinity();
  std::vector<Face> all;
  for (int axis = 0; axis < 3; ++axis) {
    all.push_back({axis, 1.0, 0.0, Eigen::Vector3d::Zero(), high});
    if (axis != 1 || !scene_.container.open_top) all.push_back({axis, -1.0, size[axis], Eigen::Vector3d::Zero(), high});
  }
  for (const auto& box : scene_.boxes) {
    if (box.until_s.value_or(std::numeric_limits<double>::infinity()) <= time_s) continue;
    const Eigen::Vector3d from = box.min_m - scene_.container.min_m, to = box.max_m - scene_.container.min_m;
    for (int axis = 0; axis < 3; ++axis) {
      all.push_back({axis, -1.0, from[axis], from.cwiseMax(0.0), to.cwiseMin(high)});
      all.push_back({axis, 1.0, to[axis], from.cwiseMax(0.0), to.cwiseMin(high)});
    }
  }
  return all;
}

void write_gauges_header(std::ostream& out, const Gauges& gauges) {
  out << "time_s";
  for (const auto& column : gauges.columns()) out << "," << column.name;
  out << "\n";
}

void write_gauges(std::ostream& out, double time_s, const std::vector<double>& values) {
  fmt::print(out, "{}", time_s);
  for (const double value : values) std::isfinite(value) ? fmt::print(out, ",{}", value) : fmt::print(out, ",");
  out << "\n";
}

}  // namespace squall::harness
