#pragma once

#include <Eigen/Core>

#include "core/particles.h"
#include "core/scene.h"
#include "core/solver.h"
#include "harness/measures.h"

namespace squall::harness {

/// Shape and volume of the water of a state, relative to the container. Lengths in m; NaN without the particles that
/// they need, but for the filled depth, a sum.
struct Water {
  Eigen::Vector3d low, high;  ///< outermost free particles, dx/2 added outwards
  Eigen::Vector3d rms;        ///< distance from the centre of mass, per axis
  double depth = k_no_value;  ///< twice the mean y of the particles that have a neighbour within H
  double filled_depth = 0.0;  ///< their volume over the floor's area
  double distortion =
      k_no_value;  ///< largest change of a particle's place relative to the centre of mass since the start
};

/// `start`: the particles that the run began with.
Water water_of(const Scene& scene, const State& state, const Particles& start);

}  // namespace squall::harness
