// Times every frame of squall on a scene file, for bench/peers/measure.py: a short frame is a handful of sub-steps.
//   squall_steps SCENE BACKEND PRESSURE THREADS WARM_UP_FRAMES FRAMES
// Prints JSON: per frame its milliseconds, sub-steps and density error.

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "backends.h"
#include "core/errors.h"

namespace {

int to_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0)
    throw squall::InputError("'" + std::string(text) + "' is no whole number >= 0");
  return value;
}

void print_list(const char* name, const std::vector<double>& values) {
  std::printf("\"%s\": [", name);
  for (std::size_t i = 0; i < values.size(); ++i) std::printf("%s%.6g", i ? ", " : "", values[i]);
  std::printf("], ");
}

void measure(squall::Solver& solver, int warm_up, int frames) {
  std::vector<double> frame_ms, substeps, error_mean, error_max;
  double simulated_s = 0.0;
  for (int i = 0; i < warm_up + frames; ++i) {
    const squall::FrameReport& report = solver.advance();
    if (report.lost > 0) throw squall::DeviceError(std::to_string(report.lost) + " particles were lost");
    if (i < warm_up) continue;
    frame_ms.push_back(report.frame_ms);
    substeps.push_back(report.substeps);
    error_mean.push_back(report.density_error_mean);
    error_max.push_back(report.density_error_max);
    simulated_s += report.dt_s * report.substeps;
  }
  std::printf("{\"particles\": %lld, ", static_cast<long long>(solver.report().active));
  print_list("frame_ms", frame_ms);
  print_list("substeps", substeps);
  print_list("density_error_mean", error_mean);
  print_list("density_error_max", error_max);
  std::printf("\"simulated_s\": %.6g, \"neighbours_mean\": %.4g}\n", simulated_s, solver.report().neighbours_mean);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 7) return std::fputs("squall_steps: SCENE BACKEND PRESSURE THREADS WARM_UP_FRAMES FRAMES\n", stderr), 2;
  squall::Settings settings;
  settings.pressure = squall::pressure_from_text(argv[3]);
  settings.threads = to_number(argv[4]);
  const auto solver = squall::make_solver(argv[2], squall::load_scene(argv[1]), settings);
  measure(*solver, to_number(argv[5]), to_number(argv[6]));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "squall_steps: %s\n", error.what());
  return 1;
}
