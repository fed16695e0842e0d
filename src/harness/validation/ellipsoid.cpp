#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/errors.h"
#include "harness/validation/formulas.h"

/// A drop x^2/a^2 + y^2/b^2 + z^2/c^2 <= 1 with velocity (x a'/a, y b'/b, z c'/c) stays one: p = rho P (1 - x^2/a^2 -
/// ...), a_i'' = 2 P/a_i, and volume is kept if P = sum (a_i'/a_i)^2/(2 sum 1/a_i^2) (Dirichlet 1860; the cylinder, c
/// infinite: Monaghan 1994).
namespace squall::harness {

namespace {

constexpr double k_step_s = 1e-5;
constexpr double k_longest_s = 20.0;

struct Shape {
  Eigen::Vector3d axis, rate;  ///< m (infinite along a cylinder), m/s

  double pressure() const {  // over rho
    double squeeze = 0.0, give = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(axis[i])) continue;
      squeeze += rate[i] * rate[i] / (axis[i] * axis[i]);
      give += 1.0 / (axis[i] * axis[i]);
    }
    return squeeze / (2.0 * give);
  }

  Eigen::Vector3d acceleration() const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    const double p = pressure();
    for (int i = 0; i < 3; ++i)
      if (std::isfinite(axis[i])) result[i] = 2.0 * p / axis[i];
    return result;
  }

  /// Midpoint rule.
  Shape after(double dt) const {
    const Shape middle{axis + 0.5 * dt * rate, rate + 0.5 * dt * acceleration()};
    return {axis + dt * middle.rate, rate + dt * middle.acceleration()};
  }
};

class Drop {
 public:
  explicit Drop(const Shape& start) : history_{start} {}

  Shape at(double time_s) {
    if (!(time_s <= k_longest_s))
      throw InputError(fmt::format("formula ellipsoid is asked for {} s; it goes up to {} s", time_s, k_longest_s));
    const auto index = static_cast<std::size_t>(std::max(0.0, time_s) / k_step_s);
    while (history_.size() <= index) history_.push_back(history_.back().after(k_step_s));
    return history_[index].after(std::max(0.0, time_s) - k_step_s * static_cast<double>(index));
  }

 private:
  std::vector<Shape> history_;
};

Shape start_shape(const FormulaRequest& request) {
  Shape shape{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), Eigen::Vector3d::Zero()};
  double divergence = 0.0, largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    const double rate = parameter_or(request, "rate_" + axis + "_1_s", 0.0);
    const auto length = request.parameters.find("semi_axis_" + axis + "_m");
    divergence += rate;
    largest = std::max(largest, std::abs(rate));
    if (length == request.parameters.end()) {
      if (i != 2 || rate != 0.0)
        throw InputError("formula ellipsoid needs semi_axis_" + axis + "_m; only z may be left out, for a cylinder");
      continue;
    }
    if (!(length->second > 0.0)) throw InputError("semi_axis_" + axis + "_m of formula ellipsoid must be above 0");
    shape.axis[i] = length->second;
    shape.rate[i] = rate * length->second;
  }
  if (std::abs(divergence) > 1e-9 * largest || largest == 0.0)
    throw InputError(
        fmt::format("rates of formula ellipsoid must add up to 0, as water keeps its volume, and not all "
                    "be 0; their sum is {} 1/s",
                    divergence));
  return shape;
}

}  // namespace

Curve make_ellipsoid(const FormulaRequest& request) {
  const Scene& scene = request.scene;
  if (scene.gravity_m_s2.norm() > 0.0)
    throw InputError("formula ellipsoid holds without gravity: vector_m_s2 = [0, 0, 0]");
  const Shape start = start_shape(request);
  const auto drop = std::make_shared<Drop>(start);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const Particles particles = initial_particles(scene);
  for (const auto& x : particles.positions) centre += x / static_cast<double>(particles.size());
  // Mean of x^2/a^2 over a cylinder's cross-section or an ellipsoid.
  const double share = std::isfinite(start.axis.z()) ? 0.2 : 0.25;
  const std::string& name = request.quantity;
  if (const Scene::Gauge* gauge = gauge_of(request); gauge != nullptr && gauge->kind == "pressure") {
    const Eigen::Vector3d at = gauge->position_m - scene.container.min_m - centre;
    const double density = scene.fluid.rest_density_kg_m3;
    return [=](double t) {
      const Shape shape = drop->at(t);
      return density * shape.pressure() * std::max(0.0, 1.0 - (at.array() / shape.axis.array()).square().sum());
    };
  }
  if (name == "kinetic_j") {
    const double mass = scene.particle_mass() * static_cast<double>(particles.size());
    return [=](double t) { return 0.5 * mass * share * drop->at(t).rate.squaredNorm(); };
  }
  if (!name.ends_with("_rms_m") && !name.ends_with("_max_m") && !name.ends_with("_min_m"))
    refuse_quantity(request, "ellipsoid",
                    "kinetic_j, a pressure gauge, and of x_, y_, z_: .._rms_m, .._max_m, .._min_m");
  const int axis = name == "front_max_m" ? 0 : axis_of(request);
  if (!std::isfinite(start.axis[axis])) refuse_quantity(request, "ellipsoid", "quantities across the cylinder alone");
  if (name.ends_with("_rms_m")) return [=](double t) { return std::sqrt(share) * drop->at(t).axis[axis]; };
  const double sign = name.ends_with("_max_m") ? 1.0 : -1.0;
  return [=](double t) { return centre[axis] + sign * drop->at(t).axis[axis]; };
}

}  // namespace squall::harness
