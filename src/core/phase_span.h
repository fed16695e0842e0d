#pragma once

#include <string>

namespace squall {

/// A stretch of a frame in which somebody did one thing. Spans of one lane lie one behind the other or inside each
/// other.
struct PhaseSpan {
  std::string name;     ///< "density"
  std::string lane;     ///< who did it: "host", "omp team", "OpenCL queue"
  double begin_ms = 0;  ///< since the frame's start
  double end_ms = 0;
};

}  // namespace squall
