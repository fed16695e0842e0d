#include "harness/validation/formulas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/nearest_name.h"

namespace squall::harness {

namespace {

/// Centre of mass and mean velocity of the particles at the start.
struct Start {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
};

Start start_of(const Scene& scene) {
  const Particles particles = initial_particles(scene);
  if (particles.size() == 0) throw InputError("ballistic needs a scene with particles at the start");
  Start start;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    start.centre += particles.positions[i];
    start.velocity += particles.velocities[i];
  }
  start.centre /= static_cast<double>(particles.size());
  start.velocity /= static_cast<double>(particles.size());
  return start;
}

Curve make_ballistic(const FormulaRequest& request) {
  const Start start = start_of(request.scene);
  const Eigen::Vector3d g = request.scene.gravity_m_s2;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const double x = start.centre[axis], v = start.velocity[axis], a = g[axis];
    if (request.quantity == name + "_cm_m") return [=](double t) { return x + t * (v + 0.5 * a * t); };
    if (request.quantity == "v" + name + "_cm_m_s") return [=](double t) { return v + a * t; };
  }
  refuse_quantity(request, "ballistic", "x_cm_m, y_cm_m, z_cm_m, vx_cm_m_s, vy_cm_m_s, vz_cm_m_s");
}

Curve make_drag_fall(const FormulaRequest& request) {
  const double g = request.scene.gravity_m_s2.norm(), terminal = parameter(request, "terminal_speed_m_s");
  if (!(terminal > 0.0))
    throw InputError(fmt::format("terminal_speed_m_s = {} of formula drag_fall must be above 0", terminal));
  if (request.quantity == "vy_cm_m_s") return [=](double t) { return -terminal * std::tanh(g * t / terminal); };
  if (request.quantity != "y_cm_m") refuse_quantity(request, "drag_fall", "y_cm_m, vy_cm_m_s");
  const double start = start_of(request.scene).centre.y();
  return [=](double t) { return start - terminal * terminal / g * std::log(std::cosh(g * t / terminal)); };
}

Curve make_hydrostatic(const FormulaRequest& request) {
  const Scene& scene = request.scene;
  const Scene::Gauge* gauge = gauge_of(request);
  if (gauge == nullptr || gauge->kind != "pressure") refuse_quantity(request, "hydrostatic", "a pressure gauge");
  const double depth = parameter_or(request, "depth_m", rest_depth(scene));
  const double below = depth - (gauge->position_m.y() - scene.container.min_m.y());
  const double pressure = scene.fluid.rest_density_kg_m3 * scene.gravity_m_s2.norm() * std::max(0.0, below);
  return [=](double) { return pressure; };
}

Curve make_weight(const FormulaRequest& request) {
  const Scene& scene = request.scene;
  if (!request.quantity.starts_with("wall_force_")) refuse_quantity(request, "weight", "wall_force_x_n, ..y_n, ..z_n");
  const int axis = request.quantity[11] - 'x';
  const double mass = scene.particle_mass() * static_cast<double>(initial_particles(scene).size());
  const double force = -mass * scene.gravity_m_s2[axis];
  return [=](double) { return force; };
}

Curve make_rest_depth(const FormulaRequest& request) {
  const double depth = parameter_or(request, "depth_m", rest_depth(request.scene));
  return [=](double) { return depth; };
}

Curve make_ritter_front(const FormulaRequest& request) {
  const Scene& scene = request.scene;
  const double g = scene.gravity_m_s2.norm(), height = parameter_or(request, "height_m", scene.fluid_depth());
  double edge = 0.0;
  for (const auto& block : scene.blocks) edge = std::max(edge, block.max_m.x() - scene.container.min_m.x());
  edge = parameter_or(request, "start_m", edge);
  const double speed = 2.0 * std::sqrt(g * height);
  return [=](double t) { return edge + speed * t; };
}

}  // namespace

const std::vector<Formula>& formulas() {
  static const std::vector<Formula> all{
      {"ballistic", "centre of mass of what falls freely", {}, make_ballistic},
      {"drag_fall", "a drop from rest in still air: v = v_t tanh(g t/v_t)", {"terminal_speed_m_s"}, make_drag_fall},
      {"hydrostatic", "rho g (depth - y) at a pressure gauge", {"depth_m"}, make_hydrostatic},
      {"weight", "- m g of all particles at the start", {}, make_weight},
      {"rest_depth", "volume of the particles at the start over the floor's area", {"depth_m"}, make_rest_depth},
      {"ritter_front",
       "front of a dam break on a dry bed, shallow water without friction (Ritter 1892)",
       {"height_m", "start_m"},
       make_ritter_front},
      {"sloshing",
       "linear waves in a box that moves along x (modal sum): x_cm_m or a level gauge",
       {"length_m", "depth_m"},
       make_sloshing},
      {"sloshing_period",
       "period of a standing wave in a box along x: 2 pi/sqrt(g k tanh(k h)), k = mode pi/length",
       {"length_m", "depth_m", "mode"},
       make_sloshing_period},
      {"ellipsoid",
       "a drop whose velocity is linear in the coordinates, without gravity (Dirichlet)",
       {"semi_axis_x_m", "semi_axis_y_m", "semi_axis_z_m", "rate_x_1_s", "rate_y_1_s", "rate_z_1_s"},
       make_ellipsoid},
  };
  return all;
}

Curve make_curve(const std::string& formula, const FormulaRequest& request) {
  std::vector<std::string> names;
  for (const auto& known : formulas()) {
    names.push_back(known.name);
    if (known.name != formula) continue;
    for (const auto& [name, value] : request.parameters)
      if (std::find(known.parameters.begin(), known.parameters.end(), name) == known.parameters.end())
        throw InputError(
            fmt::format("formula {} has no parameter '{}'; it has {}", formula, name,
                        known.parameters.empty() ? "none" : fmt::format("{}", fmt::join(known.parameters, ", "))));
    return known.make(request);
  }
  throw InputError(fmt::format("formula '{}' is unknown; did you mean '{}'? There are {}", formula,
                               nearest_name(formula, names), fmt::join(names, ", ")));
}

double parameter_or(const FormulaRequest& request, const std::string& name, double otherwise) {
  const auto found = request.parameters.find(name);
  return found == request.parameters.end() ? otherwise : found->second;
}

double parameter(const FormulaRequest& request, const std::string& name) {
  const auto found = request.parameters.find(name);
  if (found == request.parameters.end()) throw InputError("the formula needs the parameter " + name);
  return found->second;
}

int axis_of(const FormulaRequest& request) {
  const std::string& name = request.quantity;
  if (name.size() > 1 && name[1] == '_' && name[0] >= 'x' && name[0] <= 'z') return name[0] - 'x';
  throw InputError("quantity " + name + " belongs to no axis; the formula needs one that begins with x_, y_ or z_");
}

const Scene::Gauge* gauge_of(const FormulaRequest& request) {
  for (const auto& gauge : request.scene.gauges)
    if (gauge.name == request.quantity) return &gauge;
  return nullptr;
}

void refuse_quantity(const FormulaRequest& request, const std::string& formula, const std::string& allowed) {
  throw InputError(fmt::format("formula {} does not give {}; it gives {}", formula, request.quantity, allowed));
}

double rest_depth(const Scene& scene) {
  const Eigen::Vector3d size = scene.container_size();
  const auto count = static_cast<double>(initial_particles(scene).size());
  return count * scene.particle_volume() / (size.x() * size.z());
}

}  // namespace squall::harness
