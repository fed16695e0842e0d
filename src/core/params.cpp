#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "core/errors.h"
#include "core/frame_plan.h"
#include "core/rain.h"
#include "grid.h"
#include "sph_formulas.h"

namespace squall {

namespace {

/// Cells of each axis; an edge is H (1 + margin), so that no rounding of coordinate * inverse_edge in single precision
/// puts two particles within H more than one cell apart.
void set_grid(const Scene& scene, Params<double>& p) {
  const Eigen::Vector3d size = scene.container_size();
  const double support = scene.support_radius();
  const double margin = 1e-5 + std::ldexp(size.maxCoeff() / support, -22);
  const double edge = support * (1.0 + margin);
  p.inverse_edge_yz = 1.0 / edge;
  p.inverse_edge_x = k_x_fineness / edge;
  const Eigen::Vector3d cells{std::floor(size.x() * p.inverse_edge_x) + 1.0,
                              std::floor(size.y() * p.inverse_edge_yz) + 1.0,
                              std::floor(size.z() * p.inverse_edge_yz) + 1.0};
  if (cells.prod() > static_cast<double>(k_max_cells)) {
    std::ostringstream text;
    text << "the container needs a grid of " << cells.x() << " x " << cells.y() << " x " << cells.z() << " cells of "
         << support << " m, more than " << k_max_cells << "; make the container smaller or spacing_m larger";
    throw InputError(text.str());
  }
  p.cells_x = static_cast<int>(cells.x());
  p.cells_y = static_cast<int>(cells.y());
  p.cells_z = static_cast<int>(cells.z());
  p.cell_count = p.cells_x * p.cells_y * p.cells_z;
}

void set_support(const Scene& scene, Params<double>& p) {
  const double support = scene.support_radius();
  p.support_radius = support;
  p.support_squared = support * support;
  p.list_squared = support * support * (1.0 + 1e-5);
  p.inverse_support = 1.0 / support;
  p.inverse_half_support = 2.0 / support;
  p.inverse_support_squared = 1.0 / (support * support);
  p.softening = 0.01 * 0.25 * support * support;
  p.tiny = 1e-20;
}

/// The bell kernel for density and force: dfsph.
void set_bell(const Scene& scene, Params<double>& p) {
  constexpr double pi = std::numbers::pi;
  const double support = scene.support_radius();
  const double ratio = scene.fluid.support_ratio;
  const double volume = scene.particle_volume() / lattice_sum(SQUALL_BELL, ratio);
  p.density_scale = volume * 315.0 / (8192.0 * pi * std::pow(support, 3));
  p.force_scale = volume * 945.0 / (2048.0 * pi * std::pow(support, 5));
  p.density_wall_shift = p.force_wall_shift = scene.fluid.spacing_m * wall_shift(SQUALL_BELL, ratio);
  p.self_value = bell_value(1.0);
}

/// The cubic spline for density and force: wcsph.
void set_spline(const Scene& scene, Params<double>& p) {
  constexpr double pi = std::numbers::pi;
  const double support = scene.support_radius();
  const double volume = scene.particle_volume();
  const double sum = lattice_sum(SQUALL_CUBIC, scene.fluid.support_ratio);
  p.density_scale = volume * 8.0 / (pi * std::pow(support, 3)) / sum;
  p.force_scale = volume * 48.0 / (pi * std::pow(support, 4)) / sum;
  p.density_wall_shift = p.force_wall_shift =
      scene.fluid.spacing_m * wall_shift(SQUALL_CUBIC, scene.fluid.support_ratio);
  p.self_value = 1.0;
}

void set_wcsph(const Scene& scene, Params<double>& p) {
  const double c = scene.speed_of_sound();
  p.stiffness = c * c / 7.0;
  p.artificial_scale = scene.solver.artificial_viscosity * (0.5 * scene.support_radius()) * c * 0.5;
  p.viscosity_scale = 5.0 * scene.fluid.viscosity_m2_s.value_or(0.0);
}

/// Where the numbers come from: docs/dfsph.md.
void set_dfsph(const Scene& scene, Params<double>& p) {
  const double dx = scene.fluid.spacing_m;
  p.viscosity_scale = 187.0 / 7.0 * scene.fluid.viscosity_m2_s.value_or(0.0) * p.inverse_support_squared;
  p.response_guard = 1e-12 / (p.support_squared * p.support_squared);
  p.largest_warm_impulse = dx * dx;
  p.free_density = 0.9;
  p.smoothing_scale = scene.solver.xsph / scene.solver.dt_max_s * p.density_scale;
  p.core_share = 0.1;
  p.inverse_core_reach = 2.0 / dx;
}

void set_mueller(const Scene& scene, Params<double>& p) {
  constexpr double pi = std::numbers::pi;
  const double support = scene.support_radius();
  const double volume = scene.particle_volume();
  const double dx = scene.fluid.spacing_m;
  const double ratio = scene.fluid.support_ratio;
  p.density_scale = volume * 315.0 / (64.0 * pi * std::pow(support, 9)) / lattice_sum(SQUALL_POLY6, ratio);
  p.force_scale = volume * 45.0 / (pi * std::pow(support, 4));
  p.stiffness = scene.solver.stiffness_m2_s2;
  p.tension = scene.solver.negative_pressure ? 1.0 : 0.0;
  p.viscosity_scale = 2.0 * scene.fluid.viscosity_m2_s.value_or(0.0) * volume * 45.0 / (pi * std::pow(support, 5));
  p.density_wall_shift = dx * wall_shift(SQUALL_POLY6, ratio);
  p.force_wall_shift = dx * wall_shift(SQUALL_SPIKY, ratio);
  p.self_value = p.support_squared * p.support_squared * p.support_squared;
}

}  // namespace

Params<double> make_params(const Scene& scene, Pressure pressure) {
  Params<double> p{};
  set_grid(scene, p);
  const Eigen::Vector3d size = scene.container_size();
  p.size_x = size.x();
  p.size_y = size.y();
  p.size_z = size.z();
  p.lid = scene.container.open_top ? 0.0 : 1.0;
  p.clamp_distance = 0.01 * scene.fluid.spacing_m;
  p.lost_distance = 10.0 * size.y();
  set_support(scene, p);
  switch (pressure) {
    case Pressure::mueller:
      set_mueller(scene, p);
      break;
    case Pressure::wcsph:
      set_spline(scene, p);
      set_wcsph(scene, p);
      break;
    case Pressure::dfsph:
      set_bell(scene, p);
      set_dfsph(scene, p);
      break;
  }
  if (!scene.rains.empty()) {
    const double speed = terminal_speed(scene.rains.front().drop_diameter_mm);
    p.drag_coefficient = k_standard_gravity / (speed * speed);
  }
  p.steepness = std::ldexp(1.0, 30);
  p.thirtieth = 1.0 / 30.0;
  p.fifth = 0.2;
  p.two_hundred_fifty_sixth = 1.0 / 256.0;
  p.one_half = 0.5;
  return p;
}

namespace {

float single(double value) { return static_cast<float>(value); }
int single(int value) { return value; }

}  // namespace

Params<float> to_single(const Params<double>& d) {
  Params<float> s{};
#define SQUALL_MEMBER(name) s.name = single(d.name)
  SQUALL_MEMBER(cells_x);
  SQUALL_MEMBER(cells_y);
  SQUALL_MEMBER(cells_z);
  SQUALL_MEMBER(cell_count);
  SQUALL_MEMBER(inverse_edge_x);
  SQUALL_MEMBER(inverse_edge_yz);
  SQUALL_MEMBER(size_x);
  SQUALL_MEMBER(size_y);
  SQUALL_MEMBER(size_z);
  SQUALL_MEMBER(lid);
  SQUALL_MEMBER(clamp_distance);
  SQUALL_MEMBER(lost_distance);
  SQUALL_MEMBER(support_radius);
  SQUALL_MEMBER(support_squared);
  SQUALL_MEMBER(list_squared);
  SQUALL_MEMBER(inverse_support);
  SQUALL_MEMBER(inverse_half_support);
  SQUALL_MEMBER(inverse_support_squared);
  SQUALL_MEMBER(softening);
  SQUALL_MEMBER(tiny);
  SQUALL_MEMBER(density_scale);
  SQUALL_MEMBER(force_scale);
  SQUALL_MEMBER(stiffness);
  SQUALL_MEMBER(tension);
  SQUALL_MEMBER(artificial_scale);
  SQUALL_MEMBER(viscosity_scale);
  SQUALL_MEMBER(response_guard);
  SQUALL_MEMBER(largest_warm_impulse);
  SQUALL_MEMBER(free_density);
  SQUALL_MEMBER(smoothing_scale);
  SQUALL_MEMBER(core_share);
  SQUALL_MEMBER(inverse_core_reach);
  SQUALL_MEMBER(density_wall_shift);
  SQUALL_MEMBER(force_wall_shift);
  SQUALL_MEMBER(drag_coefficient);
  SQUALL_MEMBER(self_value);
  SQUALL_MEMBER(steepness);
  SQUALL_MEMBER(thirtieth);
  SQUALL_MEMBER(fifth);
  SQUALL_MEMBER(two_hundred_fifty_sixth);
  SQUALL_MEMBER(one_half);
  static_assert(sizeof s == 41 * sizeof(float), "a member of Params is missing here");
  // A particle alone sums to what single precision makes of H^6 (mueller); the others' sums are integers.
  if (d.self_value == d.support_squared * d.support_squared * d.support_squared)
    s.self_value = s.support_squared * s.support_squared * s.support_squared;
  return s;
}

Substep<float> to_single(const Substep<double>& d) {
  Substep<float> s{};
  SQUALL_MEMBER(dt);
  SQUALL_MEMBER(kick);
  SQUALL_MEMBER(acceleration_x);
  SQUALL_MEMBER(acceleration_y);
  SQUALL_MEMBER(acceleration_z);
  SQUALL_MEMBER(wind_x);
  SQUALL_MEMBER(wind_y);
  SQUALL_MEMBER(wind_z);
  SQUALL_MEMBER(box_count);
  SQUALL_MEMBER(held_count);
  SQUALL_MEMBER(released_count);
  SQUALL_MEMBER(statistics);
  SQUALL_MEMBER(previous_dt);
  SQUALL_MEMBER(warm_kick);
  SQUALL_MEMBER(inverse_kick);
  SQUALL_MEMBER(relaxation_rate);
  SQUALL_MEMBER(correction);
  SQUALL_MEMBER(reserved_0);
  SQUALL_MEMBER(reserved_1);
  SQUALL_MEMBER(reserved_2);
  static_assert(sizeof s == 20 * sizeof(float), "a member of Substep is missing here");
#undef SQUALL_MEMBER
  return s;
}

Box<float> to_single(const Box<double>& d) {
  Box<float> s{};
  for (int axis = 0; axis < 3; ++axis) {
    s.solid_min[axis] = single(d.solid_min[axis]);
    s.solid_max[axis] = single(d.solid_max[axis]);
    s.density_min[axis] = single(d.density_min[axis]);
    s.density_max[axis] = single(d.density_max[axis]);
    s.force_min[axis] = single(d.force_min[axis]);
    s.force_max[axis] = single(d.force_max[axis]);
  }
  return s;
}

}  // namespace squall
