#include "backends.h"

#include "core/reference_solver.h"
#ifdef SQUALL_HAS_OMP
#include "backend_omp/omp_backend.h"
#endif
#ifdef SQUALL_HAS_OPENCL
#include "backend_opencl/opencl_backend.h"
#endif

namespace squall {

namespace {

BackendInfo describe_reference() {
  DeviceInfo device;
  device.backend = "reference";
  device.name = "one thread";
  device.kind = "cpu";
  device.compute_units = 1;
  return {"reference", true, "", {device}};
}

BackendInfo describe_omp() {
#ifdef SQUALL_HAS_OMP
  return {"omp", true, "", openmp::devices()};
#else
  return {"omp", false, SQUALL_OMP_MISSING, {}};
#endif
}

BackendInfo describe_opencl() {
#ifdef SQUALL_HAS_OPENCL
  BackendInfo info{"opencl", true, "", {}};
  info.devices = opencl::devices(&info.problem);
  return info;
#else
  return {"opencl", false, SQUALL_OPENCL_MISSING, {}};
#endif
}

std::unique_ptr<Solver> make_empty_solver(const std::string& backend, [[maybe_unused]] const Scene& scene,
                                          [[maybe_unused]] const Settings& settings) {
  if (backend == "reference") return reference::make_solver(scene, settings);
  if (backend == "omp") {
#ifdef SQUALL_HAS_OMP
    return openmp::make_solver(scene, settings);
#else
    throw InputError("backend omp was left out of this build: " SQUALL_OMP_MISSING);
#endif
  }
  if (backend == "opencl") {
#ifdef SQUALL_HAS_OPENCL
    return opencl::make_solver(scene, settings);
#else
    throw InputError("backend opencl was left out of this build: " SQUALL_OPENCL_MISSING);
#endif
  }
  throw InputError("unknown backend '" + backend + "'; there are reference, omp and opencl");
}

}  // namespace

std::vector<BackendInfo> list_backends() { return {describe_reference(), describe_omp(), describe_opencl()}; }

std::unique_ptr<Solver> make_solver(const std::string& backend, const Scene& scene, const Settings& settings) {
  auto solver = make_empty_solver(backend, scene, settings);
  solver->load(initial_particles(scene));
  return solver;
}

}  // namespace squall
