// Times every step of SPlisHSPlasH on the column of column.py: its own library does the steps, this program only fills
// it.
//   splishsplash_steps SOLVER LAYERS WARM_UP STEPS UNTIL_S DT_MAX_S STIFFNESS VISCOSITY TOLERANCE_PERCENT
// SOLVER: wcsph or dfsph. Ends after STEPS counted steps or UNTIL_S simulated seconds, whichever comes first. Prints
// JSON.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "SPlisHSPlasH/BoundaryModel_Akinci2012.h"
#include "SPlisHSPlasH/DFSPH/TimeStepDFSPH.h"
#include "SPlisHSPlasH/Simulation.h"
#include "SPlisHSPlasH/StaticRigidBody.h"
#include "SPlisHSPlasH/TimeManager.h"
#include "SPlisHSPlasH/Viscosity/Viscosity_Standard.h"
#include "SPlisHSPlasH/WCSPH/TimeStepWCSPH.h"
#include "Utilities/Counting.h"
#include "Utilities/Logger.h"
#include "Utilities/Timing.h"

INIT_LOGGING
INIT_TIMING
INIT_COUNTING

namespace {

using Points = std::vector<Vector3r>;

struct Options {
  std::string solver;
  int layers, warm_up, steps;
  double until_s, dt_max_s, stiffness, viscosity, tolerance_percent;
};

Vector3r lattice_point(int i, int j, int k, double spacing) {
  return Vector3r(static_cast<Real>((i + 0.5) * spacing), static_cast<Real>((j + 0.5) * spacing),
                  static_cast<Real>((k + 0.5) * spacing));
}

Points water(int n, double spacing) {
  Points points;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < 2 * n; ++j)
      for (int i = 0; i < n; ++i) points.push_back(lattice_point(i, j, k, spacing));
  return points;
}

/// One layer behind floor and side walls, up to four layers above the water: Column.walls().
Points walls(int n, double spacing) {
  Points points;
  for (int j = -1; j < 2 * n + 4; ++j)
    for (int k = -1; k <= n; ++k)
      for (int i = -1; i <= 4 * n; ++i)
        if (j < 0 || i == -1 || i == 4 * n || k == -1 || k == n) points.push_back(lattice_point(i, j, k, spacing));
  return points;
}

void set_solver(SPH::Simulation& simulation, const Options& options) {
  const bool dfsph = options.solver == "dfsph";
  simulation.setSimulationMethod(dfsph ? SPH::Simulation::ENUM_SIMULATION_DFSPH
                                       : SPH::Simulation::ENUM_SIMULATION_WCSPH);
  auto* step = simulation.getTimeStep();
  if (dfsph) {
    step->setValue<Real>(SPH::TimeStepDFSPH::MAX_ERROR, static_cast<Real>(options.tolerance_percent));
    step->setValue<Real>(SPH::TimeStepDFSPH::MAX_ERROR_V, static_cast<Real>(options.tolerance_percent));
  } else {
    step->setValue<Real>(SPH::TimeStepWCSPH::STIFFNESS, static_cast<Real>(options.stiffness));
    step->setValue<Real>(SPH::TimeStepWCSPH::EXPONENT, static_cast<Real>(7.0));
  }
  simulation.setValue<int>(SPH::Simulation::CFL_METHOD, SPH::Simulation::ENUM_CFL_STANDARD);
  simulation.setValue<Real>(SPH::Simulation::CFL_FACTOR, static_cast<Real>(1.0));
  simulation.setValue<Real>(SPH::Simulation::CFL_MIN_TIMESTEPSIZE, static_cast<Real>(1e-5));
  simulation.setValue<Real>(SPH::Simulation::CFL_MAX_TIMESTEPSIZE, static_cast<Real>(options.dt_max_s));
  SPH::TimeManager::getCurrent()->setTimeStepSize(static_cast<Real>(options.dt_max_s));
}

void fill(SPH::Simulation& simulation, const Options& options) {
  const double spacing = 0.4 / options.layers;
  simulation.init(static_cast<Real>(0.5 * spacing), false);
  simulation.setValue<int>(SPH::Simulation::BOUNDARY_HANDLING_METHOD, SPH::Simulation::ENUM_AKINCI2012);
  Points points = water(options.layers, spacing);
  Points velocities(points.size(), Vector3r::Zero());
  std::vector<unsigned int> objects(points.size(), 0);
  simulation.addFluidModel("Fluid", static_cast<unsigned int>(points.size()), points.data(), velocities.data(),
                           objects.data(), 0);
  set_solver(simulation, options);
  auto* fluid = simulation.getFluidModel(0);
  fluid->setViscosityMethod(SPH::Viscosity_Standard::METHOD_NAME);
  fluid->getViscosityBase()->setValue<Real>(SPH::Viscosity_Standard::VISCOSITY_COEFFICIENT,
                                            static_cast<Real>(options.viscosity));
  Points wall_points = walls(options.layers, spacing);
  auto* boundary = new SPH::BoundaryModel_Akinci2012;  // the simulation owns it
  boundary->initModel(new SPH::StaticRigidBody, static_cast<unsigned int>(wall_points.size()), wall_points.data());
  simulation.addBoundaryModel(boundary);
  simulation.setSimulationInitialized(true);
  simulation.deferredInit();
  simulation.performNeighborhoodSearchSort();
  simulation.updateBoundaryVolume();
}

double mean_neighbours(SPH::Simulation& simulation) {
  const unsigned int count = simulation.getFluidModel(0)->numActiveParticles();
  double sum = 0.0;
  for (unsigned int i = 0; i < count; ++i) sum += simulation.numberOfNeighbors(0, 0, i);
  return sum / count;
}

struct DensityError {
  double mean = 0.0, max = 0.0;
};

/// Of max(rho / rho0 - 1, 0), as squall reports it.
DensityError density_error(SPH::Simulation& simulation) {
  auto* fluid = simulation.getFluidModel(0);
  DensityError error;
  for (unsigned int i = 0; i < fluid->numActiveParticles(); ++i) {
    const double excess =
        std::fmax(static_cast<double>(fluid->getDensity(i)) / static_cast<double>(fluid->getDensity0()) - 1.0, 0.0);
    error.mean += excess / fluid->numActiveParticles();
    error.max = std::fmax(error.max, excess);
  }
  return error;
}

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void print_list(const char* name, const std::vector<double>& values) {
  std::printf("\"%s\": [", name);
  for (std::size_t i = 0; i < values.size(); ++i) std::printf("%s%.6g", i ? ", " : "", values[i]);
  std::printf("], ");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 10) return std::fprintf(stderr, "splishsplash_steps: nine arguments, see the source\n"), 2;
  const Options options{argv[1],
                        std::atoi(argv[2]),
                        std::atoi(argv[3]),
                        std::atoi(argv[4]),
                        std::atof(argv[5]),
                        std::atof(argv[6]),
                        std::atof(argv[7]),
                        std::atof(argv[8]),
                        std::atof(argv[9])};
  SPH::Simulation& simulation = *SPH::Simulation::getCurrent();
  fill(simulation, options);
  for (int i = 0; i < options.warm_up; ++i) simulation.getTimeStep()->step();

  std::vector<double> step_ms, error_mean, error_max;
  auto* time = SPH::TimeManager::getCurrent();
  const double start_s = static_cast<double>(time->getTime());
  for (int i = 0; i < options.steps && static_cast<double>(time->getTime()) - start_s < options.until_s; ++i) {
    const double start = now_ms();
    simulation.getTimeStep()->step();
    step_ms.push_back(now_ms() - start);
    const DensityError error = density_error(simulation);
    error_mean.push_back(error.mean);
    error_max.push_back(error.max);
  }
  std::printf("{\"particles\": %u, ", simulation.getFluidModel(0)->numActiveParticles());
  print_list("step_ms", step_ms);
  print_list("density_error_mean", error_mean);
  print_list("density_error_max", error_max);
  std::printf("\"simulated_s\": %.6g, \"neighbours_mean\": %.4g}\n", static_cast<double>(time->getTime()) - start_s,
              mean_neighbours(simulation));
  return 0;
}
