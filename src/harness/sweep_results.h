#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "harness/context.h"
#include "harness/results_json.h"
#include "harness/sweep.h"

namespace squall::harness {

/// A sweep and what a reader must know about it.
struct SweepResult {
  Sweep sweep;
  SweepPlan plan;
  Context context;
  SceneInfo scene;  ///< as written, before it was scaled
  double frame_rate_hz = 60.0;
};

/// {schema, context, scene, measured, points, sizes, crossover, budget, agreement, notes} (docs/results.md).
Json to_json(const SweepResult& result);

/// points.csv: a line per run and size; names and units as in the JSON.
void write_points_header(std::ostream& out);
void write_point(std::ostream& out, const SweepPoint& point);

/// Which part of the scene was measured, in words.
std::string measured_part(const SweepResult& result);

}  // namespace squall::harness
