#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frame_plan.h"
#include "core/scene.h"
#include "core/settings.h"
#include "core/solver.h"

namespace squall::harness {

/// What the model says of one particle: its pressure, and what the walls do to it.
struct WaterPoint {
  Eigen::Vector3d position, velocity;  ///< as in Particles [m, m/s]
  double pressure_pa = 0.0;
  Eigen::Vector3d wall_acceleration;  ///< m/s^2: of the container's faces and the boxes on it, without the safety net
};

/// Pressures and wall forces of a state, found in double with the passes of the reference backend, whichever backend
/// the state came from. Those of wcsph and mueller follow from the positions; dfsph's pressures are part of the state.
class WaterField {
 public:
  WaterField(const Scene& scene, Pressure pressure);

  /// The free particles whose distance from one of the places (relative to the container) is at most `reach` [m] on
  /// every axis, with all their neighbours taken into account.
  std::vector<WaterPoint> around(const State& state, const std::vector<Eigen::Vector3d>& places, double reach) const;

 private:
  Scene scene_;
  Pressure pressure_;
  Params<double> params_;
  std::vector<Box<double>> boxes_;
};

/// Simulated time [s] of a state.
double time_of(const Scene& scene, const State& state);

/// Boxes that stand at a time: as many of make_boxes().
int standing_boxes(const Scene& scene, double time_s);

}  // namespace squall::harness
