#include "harness/study/observables.h"

#include <limits>

namespace squall::harness {

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr const char* k_floor_pressure = "floor_pressure_pa";

std::vector<double> values_at(const TimeSeries& series, const std::string& name, const std::vector<double>& times,
                              double earlier_s) {
  std::vector<double> values;
  const Column* column = series.find(name);
  for (const double time : times)
    values.push_back(column == nullptr ? k_nan : value_at(*column, time - earlier_s).value_or(k_nan));
  return values;
}

}  // namespace

const std::vector<StudyObservable>& study_observables() {
  static const std::vector<StudyObservable> all{
      {"x_cm_m", "depth", true, false},
      {"y_cm_m", "depth", true, false},
      {"front_m", "depth", true, false},
      {"energy_j", "M g D/2", true, false},
      {k_floor_pressure, "rho0 g D/2", false, false},
      {"density_error_mean", "1", false, true},
  };
  return all;
}

std::vector<std::string> error_names() {
  std::vector<std::string> names{k_combined_error};
  for (const auto& observable : study_observables()) names.push_back(observable.name);
  return names;
}

std::map<std::string, double> observable_scales(const Scene& scene) {
  const double depth = scene.fluid_depth(), speed = scene.reached_speed();
  const double mass = static_cast<double>(particle_capacity(scene)) * scene.particle_mass();
  return {{"x_cm_m", depth},
          {"y_cm_m", depth},
          {"front_m", depth},
          {"energy_j", 0.5 * mass * speed * speed},
          {k_floor_pressure, 0.5 * scene.fluid.rest_density_kg_m3 * speed * speed},
          {"density_error_mean", 1.0}};
}

std::map<std::string, std::vector<double>> sample_observables(const Scene& scene, const TimeSeries& series,
                                                              const std::vector<double>& times, double frame_s) {
  std::map<std::string, std::vector<double>> samples;
  for (const auto& observable : study_observables())
    if (observable.name != k_floor_pressure) samples[observable.name] = values_at(series, observable.name, times, 0.0);
  // A frame's mean force belongs to its middle.
  auto force = values_at(series, "wall_force_y_n", times, 0.5 * frame_s);
  const Eigen::Vector3d size = scene.container_size();
  for (double& value : force) value /= size.x() * size.z();
  samples[k_floor_pressure] = std::move(force);
  return samples;
}

}  // namespace squall::harness
