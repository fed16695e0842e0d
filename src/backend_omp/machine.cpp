#include "backend_omp/machine.h"

#include <omp.h>
#include <pthread.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "backend_omp/omp_backend.h"
#include "backend_omp/passes.h"
#include "core/address_space.h"

namespace squall::openmp {

namespace {

std::size_t stack_bytes() {
  pthread_attr_t attributes;
  std::size_t bytes = 0;
  pthread_attr_init(&attributes);
  pthread_attr_getstacksize(&attributes, &bytes);
  pthread_attr_destroy(&attributes);
  return bytes;
}

}  // namespace

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "CPU";
}

Simd choose_simd(Simd wanted) {
  const std::vector<Simd> available = available_simd();
  if (wanted == Simd::best) return available.back();
  if (std::find(available.begin(), available.end(), wanted) == available.end())
    throw DeviceError(std::string("this machine cannot run ") + to_string(wanted) + " code; it can run up to " +
                      to_string(available.back()));
  return wanted;
}

int choose_threads(int wanted) {
  const int threads = wanted > 0 ? wanted : omp_get_max_threads();
  const std::string problem = address_space_problem("a team of " + std::to_string(threads) + " threads",
                                                    static_cast<std::size_t>(threads - 1) * stack_bytes());
  if (!problem.empty()) throw DeviceError(problem + ", or use fewer threads");
  return threads;
}

std::vector<DeviceInfo> devices() {
  DeviceInfo device;
  device.backend = "omp";
  device.name = processor_name();
  device.kind = "cpu";
  device.compute_units = static_cast<int>(std::thread::hardware_concurrency());
  device.version = std::string("up to ") + to_string(available_simd().back());
  return {device};
}

}  // namespace squall::openmp
