#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/settings.h"
#include "core/solver.h"
#include "harness/water_field.h"

namespace squall::harness {

/// One number that a scene's gauges give.
struct GaugeColumn {
  std::string name;           ///< the gauge's; of a velocity with _x, _y, _z behind it
  std::string unit;           ///< "m", "Pa" or "m/s"
  bool at_half_step = false;  ///< velocities belong to the middle of the last sub-step
  bool is_pressure = false;
};

/// What a gauge shows, and whether it stands in water: where it does not, a level is what stands there, a pressure the
/// air's, 0, and a velocity NaN.
struct GaugeReading {
  double value = 0.0;
  bool in_water = false;
};

/// What a scene's gauges show of a state (docs/scenes.md, [[gauge]]).
class Gauges {
 public:
  Gauges(const Scene& scene, Pressure pressure);

  const std::vector<GaugeColumn>& columns() const { return columns_; }
  bool has_pressure() const;

  /// A reading per column.
  std::vector<GaugeReading> readings(const State& state) const;
  /// Their values alone.
  std::vector<double> read(const State& state) const;

 private:
  /// A flat piece of a wall. Positions relative to the container.
  struct Face {
    int axis = 0;               ///< of its normal
    double sign = 1.0;          ///< of the normal into the water
    double plane = 0.0;         ///< m
    Eigen::Vector3d low, high;  ///< m: its edges; the component along the normal means nothing
  };

  GaugeReading level(const State& state, const Eigen::Vector3d& at) const;
  GaugeReading pressure(const State& state, const std::vector<WaterPoint>& points, const Eigen::Vector3d& at) const;
  GaugeReading wall_pressure(const Face& face, const std::vector<WaterPoint>& points, const Eigen::Vector3d& at) const;
  bool nearest_face(double time_s, const Eigen::Vector3d& at, Face& nearest) const;
  std::vector<Face> faces(double time_s) const;

  Scene scene_;
  WaterField field_;
  std::vector<GaugeColumn> columns_;
  std::vector<Eigen::Vector3d> places_;  ///< of gauges that need pressures or velocities, relative to the container
};

/// gauges.csv: time_s and a column per number; a cell without a value is empty.
void write_gauges_header(std::ostream& out, const Gauges& gauges);
void write_gauges(std::ostream& out, double time_s, const std::vector<double>& values);

}  // namespace squall::harness
