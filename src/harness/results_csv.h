#pragma once

#include <iosfwd>
#include <string>

#include "core/scene.h"
#include "harness/measures.h"
#include "harness/row.h"
#include "harness/run.h"

namespace squall::harness {

/// frames.csv: a line per counted frame; names and units as in the JSON. `run` is the run's label.
void write_frames_header(std::ostream& out);
void write_frame(std::ostream& out, const std::string& run, const FrameRecord& frame);

/// series.csv: a line per frame of what the water did; a cell without a value is empty.
void write_series_header(std::ostream& out);
void write_observation(std::ostream& out, const Observation& observation);

/// frame_000000.csv: id,x,y,z,vx,vy,vz in world coordinates [m, m/s], in ascending ids, lost particles left out.
/// Velocities belong to the middle of the last sub-step.
void write_particles(std::ostream& out, const Scene& scene, const State& state);

}  // namespace squall::harness
