#include "harness/validation/observer.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.h"
#include "core/frame_plan.h"
#include "grid.h"
#include "harness/measures.h"
#include "harness/present.h"
#include "harness/validation/water.h"

namespace squall::harness {

namespace {

/// The time [s] that velocities of a state belong to.
double half_step_time(const State& state, double time_s) { return time_s - 0.5 * state.clock.previous_dt; }

/// Sums over all particles that are not lost, at the half step.
struct Motion {
  double count = 0.0, kinetic = 0.0, potential = 0.0;  ///< energies per mass
  double fastest = k_no_value;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< about the centre of mass, per mass
};

Motion motion_of(const Scene& scene, const State& state) {
  const Particles& particles = state.particles;
  const double back = 0.5 * state.clock.previous_dt;
  Motion sum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Eigen::Vector3d& v = particles.velocities[i];
    if (is_lost(particles.positions[i].x())) continue;
    const Eigen::Vector3d x = particles.positions[i] - back * v;
    sum.count += 1.0;
    sum.centre += x;
    sum.velocity += v;
    sum.angular += x.cross(v);
    sum.kinetic += 0.5 * v.squaredNorm();
    sum.potential -= scene.gravity_m_s2.dot(x);
    sum.fastest = std::fmax(sum.fastest, v.norm());  // of NaN and a speed: the speed
  }
  sum.angular -= sum.centre.cross(sum.velocity) / sum.count;  // NaN without particles, as is their centre
  return sum;
}

/// Velocity of each particle by id; NaN for ids that are not free.
std::vector<Eigen::Vector3d> velocities_by_id(const Scene& scene, const State& state) {
  const Present present(scene, time_of(scene, state));
  const Particles& particles = state.particles;
  std::uint32_t last = 0;
  for (const auto id : particles.ids) last = std::max(last, id);
  std::vector<Eigen::Vector3d> velocities(particles.size() == 0 ? 0 : last + std::size_t{1},
                                          Eigen::Vector3d::Constant(k_no_value));
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (present.is_free(particles, i)) velocities[particles.ids[i]] = particles.velocities[i];
  return velocities;
}

}  // namespace

const std::vector<Quantity>& quantities() {
  static const std::string k_any = "a particle", k_free = "a free particle";
  static const std::vector<Quantity> all{
      {"front_m", "m", "97th percentile of x in the lowest 2 dx, plus dx/2", "a free particle in the lowest 2 dx"},
      {"front_max_m", "m", "largest x, plus dx/2", k_free},
      {"height_m", "m", "highest particle that has a neighbour, within H of x = 0, plus dx/2",
       "a free particle with a neighbour within H of x = 0"},
      {"x_cm_m", "m", "centre of mass", k_any},
      {"y_cm_m", "m", "centre of mass", k_any},
      {"z_cm_m", "m", "centre of mass", k_any},
      {"x_min_m", "m", "smallest x, less dx/2", k_free},
      {"y_min_m", "m", "smallest y, less dx/2", k_free},
      {"z_min_m", "m", "smallest z, less dx/2", k_free},
      {"x_max_m", "m", "largest x, plus dx/2", k_free},
      {"y_max_m", "m", "largest y, plus dx/2", k_free},
      {"z_max_m", "m", "largest z, plus dx/2", k_free},
      {"x_rms_m", "m", "root mean square distance from the centre of mass along x", k_free},
      {"y_rms_m", "m", "root mean square distance from the centre of mass along y", k_free},
      {"z_rms_m", "m", "root mean square distance from the centre of mass along z", k_free},
      {"depth_m", "m", "twice the mean y of all particles that have a neighbour: the depth of settled water",
       "a free particle with a neighbour"},
      {"filled_depth_m", "m", "their number times dx^3 over the area of the container's floor", ""},
      {"distortion_m", "m", "largest change of a particle's place relative to the centre of mass, since the start",
       "a particle of the start"},
      {"mass_kg", "kg", "of all particles that are not lost", ""},
      {"kinetic_j", "J", "kinetic energy", ""},
      {"potential_j", "J", "potential energy, 0 at the min corner", ""},
      {"energy_j", "J", "kinetic plus potential energy", ""},
      {"vx_cm_m_s", "m/s", "velocity of the centre of mass", k_any},
      {"vy_cm_m_s", "m/s", "velocity of the centre of mass", k_any},
      {"vz_cm_m_s", "m/s", "velocity of the centre of mass", k_any},
      {"max_speed_m_s", "m/s", "largest speed of a particle", k_any},
      {"momentum_x_kg_m_s", "kg m/s", "momentum", ""},
      {"momentum_y_kg_m_s", "kg m/s", "momentum", ""},
      {"momentum_z_kg_m_s", "kg m/s", "momentum", ""},
      {"angular_momentum_x_kg_m2_s", "kg m^2/s", "angular momentum about the centre of mass", k_any},
      {"angular_momentum_y_kg_m2_s", "kg m^2/s", "angular momentum about the centre of mass", k_any},
      {"angular_momentum_z_kg_m2_s", "kg m^2/s", "angular momentum about the centre of mass", k_any},
      {"wall_force_x_n", "N", "force of all walls and boxes on the water, mean over a frame, from its momentum", ""},
      {"wall_force_y_n", "N", "the same along y: the floor's, where there is no lid and no box", ""},
      {"wall_force_z_n", "N", "the same along z", ""},
      {"density_error_mean", "1", "mean of max(rho/rho0 - 1, 0)", k_free},
      {"density_error_max", "1", "largest rho/rho0 - 1", k_free},
  };
  return all;
}

std::string unit_of(const Scene& scene, const std::string& quantity) {
  for (const auto& known : quantities())
    if (known.name == quantity) return known.unit;
  const Gauges gauges(scene, Pressure::wcsph);
  for (const auto& column : gauges.columns())
    if (column.name == quantity) return column.unit;
  return "";
}

std::vector<std::string> quantity_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& quantity : quantities()) names.push_back(quantity.name);
  const Gauges gauges(scene, Pressure::wcsph);
  for (const auto& column : gauges.columns()) {
    if (std::find(names.begin(), names.end(), column.name) != names.end())
      throw InputError("a gauge of " + scene.name + " is called '" + column.name +
                       "', as one of the quantities that every scene has; give it another name");
    names.push_back(column.name);
  }
  return names;
}

Observer::Observer(const Scene& scene, Pressure pressure, int samples_per_frame)
    : scene_(scene), gauges_(scene, pressure), samples_per_frame_(static_cast<std::size_t>(samples_per_frame)) {
  for (const auto& quantity : quantities())
    series_.columns.push_back({quantity.name, quantity.unit, {}, {}, false, quantity.needs});
  for (const auto& column : gauges_.columns())
    series_.columns.push_back({column.name, column.unit, {}, {}, column.is_pressure, "water within H of the gauge"});
}

Column& Observer::column(const std::string& name) {
  const auto found = std::find_if(series_.columns.begin(), series_.columns.end(),
                                  [&](const auto& column) { return column.name == name; });
  return *found;
}

void Observer::put(const std::string& name, double time_s, double value) { column(name).add(time_s, value); }

void Observer::put_axes(const std::string& before, const std::string& after, double time_s,
                        const Eigen::Vector3d& value) {
  for (int axis = 0; axis < 3; ++axis) put(before + "xyz"[axis] + after, time_s, value[axis]);
}

void Observer::add(const State& state, const FrameReport* report) {
  const double time_s = time_of(scene_, state);
  if (!before_) start_ = state.particles;
  add_positions(state, time_s);
  add_motion(state, time_s);
  if (before_) add_wall_force(state, time_s);
  add_gauges(state, time_s);
  if (report != nullptr) {
    const bool any = report->active > 0;
    put("density_error_mean", time_s, any ? report->density_error_mean : k_no_value);
    put("density_error_max", time_s, any ? report->density_error_max : k_no_value);
  }
  before_ = state;
}

void Observer::add_positions(const State& state, double time_s) {
  const Observation seen = observe(scene_, state.particles, time_s);
  put("front_m", time_s, seen.front_m);
  put("front_max_m", time_s, seen.front_max_m);
  put("height_m", time_s, seen.height_m);
  put_axes("", "_cm_m", time_s, seen.centre_m);
  const Water water = water_of(scene_, state, start_);
  put_axes("", "_min_m", time_s, water.low);
  put_axes("", "_max_m", time_s, water.high);
  put_axes("", "_rms_m", time_s, water.rms);
  put("depth_m", time_s, water.depth);
  put("filled_depth_m", time_s, water.filled_depth);
  put("distortion_m", time_s, water.distortion);
}

void Observer::add_motion(const State& state, double time_s) {
  const Motion motion = motion_of(scene_, state);
  const double half = half_step_time(state, time_s), mass = scene_.particle_mass();
  put("mass_kg", time_s, mass * motion.count);
  put("kinetic_j", half, mass * motion.kinetic);
  put("potential_j", half, mass * motion.potential);
  put("energy_j", half, mass * (motion.kinetic + motion.potential));
  put_axes("v", "_cm_m_s", half, motion.velocity / motion.count);  // NaN without particles
  put("max_speed_m_s", half, motion.fastest);
  put_axes("momentum_", "_kg_m_s", half, mass * motion.velocity);
  put_axes("angular_momentum_", "_kg_m2_s", half, mass * motion.angular);
}

/// What changed the momentum of the free particles between two half steps beside gravity: kicks add up to exactly that
/// span. Particles that came, went or were freed in between are left out.
void Observer::add_wall_force(const State& state, double time_s) {
  const double from = half_step_time(*before_, time_of(scene_, *before_)), to = half_step_time(state, time_s);
  const auto earlier = velocities_by_id(scene_, *before_), later = velocities_by_id(scene_, state);
  const Eigen::Vector3d carried = container_velocity(scene_, to) - container_velocity(scene_, from);
  Eigen::Vector3d gained = Eigen::Vector3d::Zero();
  for (std::size_t id = 0; id < std::min(earlier.size(), later.size()); ++id) {
    const Eigen::Vector3d change = later[id] - earlier[id] + carried - (to - from) * scene_.gravity_m_s2;
    if (change.allFinite()) gained += change;
  }
  put_axes("wall_force_", "_n", 0.5 * (from + to), scene_.particle_mass() / (to - from) * gained);
}

void Observer::add_gauges(const State& state, double time_s) {
  const auto values = gauges_.readings(state);
  const auto& columns = gauges_.columns();
  if (before_) recent_.push_back(values);
  const bool full = recent_.size() == samples_per_frame_;
  const double span = static_cast<double>(samples_per_frame_) / scene_.time.frame_rate_hz;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (!columns[c].is_pressure) {
      put(columns[c].name, columns[c].at_half_step ? half_step_time(state, time_s) : time_s, values[c].value);
    } else if (full) {
      double sum = 0.0;
      bool is_dry = true;
      for (const auto& sample : recent_) {
        sum += sample[c].value;
        is_dry = is_dry && !sample[c].in_water;
      }
      // A mean belongs to the middle of its samples.
      put(columns[c].name, time_s - 0.5 * span * (1.0 - 1.0 / static_cast<double>(recent_.size())),
          sum / static_cast<double>(recent_.size()));
      column(columns[c].name).is_dry.push_back(is_dry);
    }
  }
  if (full) recent_.clear();
}

}  // namespace squall::harness
