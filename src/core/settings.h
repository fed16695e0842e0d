#pragma once

#include <cstdint>
#include <string>

namespace squall {

/// Where pressure comes from.
enum class Pressure {
  mueller,  ///< Müller, Charypar, Gross 2003, as the 2016 report prints it
  wcsph,    ///< weakly compressible: Tait's equation, one kernel for density and force
  dfsph,    ///< incompressible: Bender & Koschier 2015/2017
};

enum class Precision { single_precision, double_precision };

/// Width of vectors: the omp backend's instruction set (best: the widest the machine has), the opencl backend's lanes
/// (scalar 1, avx2 8, avx512 16; best: by the device).
enum class Simd { best, scalar, avx2, avx512 };

/// How positions reach the host (docs/readback.md). Backends in host memory deliver in place, whatever the mode.
enum class Readback {
  none,       ///< not at all: state stays on the device
  blocking,   ///< float4 into pageable memory after every sub-step: what the 2016 report did
  pinned,     ///< float4 into a mapped, pinned buffer once per frame
  mapped,     ///< the particle buffer itself, mapped: no copy where device and host share memory
  async,      ///< float4 of the frame before, into pinned buffers in turn, while this frame computes
  quantized,  ///< 16 bits per coordinate, made on the device: 6 bytes per particle
};

/// How the opencl backend cuts its work into work-items. No value changes a bit of the result, only speed. 0
/// everywhere: by the device.
struct WorkSizes {
  int group = 0;   ///< work-items per group, where a work-item is a particle: a power of two, 16..1024
  int parts = 0;   ///< shares of the water per compute unit, where particles go in vectors: 1..64
  int chunks = 0;  ///< chunks per compute unit, where the sort goes by chunks, and of sums: 1..64
  bool operator==(const WorkSizes&) const = default;
};

/// Throws InputError for a value out of its range.
void check(const WorkSizes& work);

/// What a run is, beside its scene. The defaults are the best that this version has.
struct Settings {
  Pressure pressure = Pressure::dfsph;
  Precision precision = Precision::single_precision;
  Simd simd = Simd::best;
  Readback readback = Readback::mapped;
  int threads = 0;         ///< 0: as many as the machine has; CPU devices are split to this many compute units
  std::string device;      ///< OpenCL device: its index in `squall devices`, or part of its name; empty: the first
  std::uint64_t seed = 1;  ///< of the rain
  WorkSizes work;          ///< of the opencl backend
  /// s: every sub-step has this length and a frame as many as fit into it, at most k_max_substeps, whatever the bounds
  /// of the time step say; 0: as planned (docs/physics.md). For those who look for these bounds.
  double fixed_step_s = 0.0;
  bool statistics = true;  ///< fill density_error_* and neighbours_mean of the frame report
  bool profile = false;    ///< fill phase_ms; slows OpenCL down
  bool trace = false;      ///< fill spans of the frame report; slows OpenCL down as profile does
};

const char* to_string(Pressure pressure);
const char* to_string(Precision precision);
const char* to_string(Simd simd);
const char* to_string(Readback readback);

/// The other way round. Throws InputError that lists the valid names, and says so if a name is not in this version.
Pressure pressure_from_text(const std::string& text);
Precision precision_from_text(const std::string& text);
Simd simd_from_text(const std::string& text);
Readback readback_from_text(const std::string& text);

}  // namespace squall
