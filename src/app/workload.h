#pragma once

#include <cstdint>
#include <string>

#include "app/options.h"
#include "core/scene.h"
#include "harness/results_json.h"

namespace squall::app {

/// A scene as the options change it.
struct Workload {
  Scene scene;
  Pressure pressure = Settings{}.pressure;
  harness::SceneInfo info;
};

/// Loads the scene and applies --particles, --dt-max and --pressure, which win over what it says. Throws InputError.
Workload load_workload(const Options& options);

/// The workload at the size nearest to this many particles. Throws InputError if its scene cannot be scaled.
Workload scaled(const Workload& workload, std::int64_t particles);

/// One line about the scene: name, particles, spacing, pressure solver.
std::string headline(const Workload& workload);

/// The workload as a scene file that gives the same water again, wherever it is stored.
std::string print_workload(const Workload& workload);

}  // namespace squall::app
