#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "backends.h"

/// Every way to run a scene that the tests of solvers go through. Nothing here asks what was built: a backend that is
/// missing or cannot run throws when its solver is made, and its tests fail.
namespace squall::test {

struct BackendUnderTest {
  std::string name;  ///< begins with the backend's, which ctest filters by
  std::string backend;
  Settings settings;

  std::unique_ptr<Solver> make(const Scene& scene) const { return make_solver(backend, scene, settings); }

  bool is_single() const { return settings.precision == Precision::single_precision; }
  double epsilon() const {
    return is_single() ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
  }
};

inline void PrintTo(const BackendUnderTest& under_test, std::ostream* out) { *out << under_test.name; }

inline BackendUnderTest reference(Precision precision, Pressure pressure) {
  const bool single = precision == Precision::single_precision;
  BackendUnderTest made{single ? "reference_single" : "reference_double", "reference", {}};
  made.settings.precision = precision;
  made.settings.pressure = pressure;
  return made;
}

inline BackendUnderTest omp(const std::string& variant, int threads, Simd simd, Pressure pressure,
                            Precision precision = Precision::single_precision) {
  BackendUnderTest made{"omp_" + variant, "omp", {}};
  made.settings.precision = precision;
  made.settings.threads = threads;
  made.settings.simd = simd;
  made.settings.pressure = pressure;
  return made;
}

/// Each width has kernels of its own: scalar those of GPUs, avx2 and avx512 those of CPU devices, 8 and 16 lanes wide,
/// 4 and 8 in double precision.
inline BackendUnderTest opencl(const std::string& variant, Simd simd, Pressure pressure,
                               Precision precision = Precision::single_precision) {
  BackendUnderTest made{"opencl_" + variant, "opencl", {}};
  made.settings.precision = precision;
  made.settings.simd = simd;
  made.settings.pressure = pressure;
  return made;
}

/// Instruction sets of this processor, asked of the processor and not of the backend under test.
inline std::vector<Simd> processor_simd() {
  std::vector<Simd> sets = {Simd::scalar};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.push_back(Simd::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw"))
    sets.push_back(Simd::avx512);
#endif
  return sets;
}

/// Those that promise the same bits as each other: strict ones of one precision, the specification last.
inline std::vector<BackendUnderTest> bitwise_backends(Pressure pressure,
                                                      Precision precision = Precision::single_precision) {
  std::vector<BackendUnderTest> all;
  for (const int threads : {1, 2, 3})
    all.push_back(omp(std::to_string(threads) + "_threads", threads, Simd::best, pressure, precision));
  for (const Simd simd : processor_simd()) all.push_back(omp(to_string(simd), 2, simd, pressure, precision));
  const bool single = precision == Precision::single_precision;
  all.push_back(opencl("particles", Simd::scalar, pressure, precision));
  all.push_back(opencl(single ? "float8" : "double4", Simd::avx2, pressure, precision));
  all.push_back(opencl(single ? "float16" : "double8", Simd::avx512, pressure, precision));
  all.push_back(reference(precision, pressure));
  return all;
}

inline constexpr Precision k_precisions[] = {Precision::single_precision, Precision::double_precision};

/// All of them; of double precision one beside the reference, since all give the same bits (same_bits_test.cpp).
inline std::vector<BackendUnderTest> all_backends(Pressure pressure) {
  std::vector<BackendUnderTest> all = bitwise_backends(pressure);
  all.push_back(omp("double", 2, Simd::best, pressure, Precision::double_precision));
  all.push_back(reference(Precision::double_precision, pressure));
  return all;
}

/// Those that have dfsph in this version.
inline std::vector<BackendUnderTest> dfsph_backends() { return all_backends(Pressure::dfsph); }

/// All of them with every pressure solver that they have; names end in the pressure solver's.
inline std::vector<BackendUnderTest> all_backends_and_pressures() {
  std::vector<BackendUnderTest> all;
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller, Pressure::dfsph})
    for (BackendUnderTest under_test : all_backends(pressure)) {
      under_test.name += std::string("_") + to_string(pressure);
      all.push_back(under_test);
    }
  return all;
}

/// Base of the tests that run once for each.
class OnEveryBackend : public testing::TestWithParam<BackendUnderTest> {
 protected:
  std::unique_ptr<Solver> make(const Scene& scene) const { return GetParam().make(scene); }

  /// Error bound of `roundings` operations on values up to `scale` in this backend's precision.
  double rounding(double roundings, double scale) const { return roundings * GetParam().epsilon() * scale; }
};

/// Instantiates the tests of a class that is derived from OnEveryBackend.
#define SQUALL_ON_EVERY_BACKEND(suite)                                                       \
  INSTANTIATE_TEST_SUITE_P(Backends, suite, testing::ValuesIn(all_backends_and_pressures()), \
                           [](const testing::TestParamInfo<BackendUnderTest>& info) { return info.param.name; })

}  // namespace squall::test
