#include "app/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "app/exit_codes.h"

namespace squall::app {

namespace {

template <class Value>
Value pick(const char* option, const std::string& text, std::initializer_list<Value> values,
           std::initializer_list<const char*> later = {}) {
  std::string names;
  for (const Value value : values) {
    if (text == to_string(value)) return value;
    names += std::string(names.empty() ? "" : ", ") + to_string(value);
  }
  for (const char* name : later)
    if (text == name) throw UsageError(fmt::format("{} {} is not in this version; it has {}", option, text, names));
  throw UsageError(fmt::format("{} '{}' is unknown; there are {}", option, text, names));
}

}  // namespace

Pressure parse_pressure(const std::string& text) {
  return pick("--pressure", text, {Pressure::mueller, Pressure::wcsph, Pressure::dfsph});
}

Precision parse_precision(const std::string& text) {
  if (text == "single") return Precision::single_precision;
  if (text == "double") return Precision::double_precision;
  throw UsageError(fmt::format("--precision '{}' is unknown; there are single, double", text));
}

Simd parse_simd(const std::string& text) {
  return pick("--simd", text, {Simd::scalar, Simd::avx2, Simd::avx512, Simd::best});
}

Readback parse_readback(const std::string& text) {
  return pick(
      "--readback", text,
      {Readback::none, Readback::blocking, Readback::pinned, Readback::mapped, Readback::async, Readback::quantized});
}

std::string parse_backend(const std::string& text) {
  if (text == "reference" || text == "omp" || text == "opencl") return text;
  throw UsageError(fmt::format("--backend '{}' is unknown; there are reference, omp, opencl", text));
}

int frames_of(const Options& options, const Scene& scene) {
  if (options.frames) return *options.frames;
  const double seconds = options.seconds.value_or(scene.time.duration_s);
  constexpr double k_rounding = 1e-9;  // 0.5 s at 60 Hz are 30 frames, however 0.5 * 60 rounds
  const double frames = std::ceil(seconds * scene.time.frame_rate_hz - k_rounding);
  if (!(frames <= 1e7))
    throw UsageError(fmt::format("{} s at {} Hz are more than 10,000,000 frames; lower --seconds", seconds,
                                 scene.time.frame_rate_hz));
  return std::max(1, static_cast<int>(frames));
}

}  // namespace squall::app
