#include "app/option_groups.h"

#include "app/checks.h"
#include "app/option_adding.h"
#include "core/scene_keys.h"

namespace squall::app {

void add_output_options(CLI::App& command, Options& options) {
  add(command, "--json", options.json,
      "Write the result as JSON to FILE, or with - to stdout, which then holds nothing else")
      ->type_name("FILE");
  command.add_flag("--quiet", options.quiet, "No progress bar and no notes on stderr")->envname("SQUALL_QUIET");
}

void add_particles(CLI::App& command, Options& options) {
  add(command, "--particles", options.particles, "Change the spacing so that about N particles result")
      ->check(CLI::Range(std::int64_t{1}, scene_keys::k_max_particles))
      ->type_name("N");
}

void add_water_options(CLI::App& command, Options& options, RawOptions& raw) {
  command.add_option("scene", options.scene, "Scene file (TOML)")->required()->type_name("SCENE");
  add_pressure(command, raw.pressure);
  add(command, "--dt-max", options.dt_max_s, "Longest sub-step [s]; else the scene's")
      ->check(within(1e-7, 1.0))
      ->type_name("S");
  add(command, "--seed", options.seed, "Of the rain (1)")->check(unsigned_number())->type_name("N");
}

void add_solver_options(CLI::App& command, RawOptions& raw) {
  add(command, "--simd", raw.simd,
      "scalar, avx2 or avx512: width of omp's vectors (else the widest there is) and of opencl's (else by device)")
      ->type_name("NAME");
  add(command, "--precision", raw.precision, "single or double; else single, and double with reference")
      ->type_name("NAME");
}

void add_length_options(CLI::App& command, Options& options) {
  add(command, "--frames", options.frames, "Frames to measure")->check(CLI::Range(1, 10'000'000))->type_name("N");
  add(command, "--seconds", options.seconds, "The same as simulated time [s]")->check(positive())->type_name("S");
}

void add_measuring_options(CLI::App& command, Options& options, RawOptions& raw) {
  add_solver_options(command, raw);
  add_length_options(command, options);
  add(command, "--budget-ms", options.budget_ms, "Exit 7 if the 95th percentile of frame time exceeds this")
      ->check(positive())
      ->type_name("F");
  command.add_flag("--tune", options.tune, "Measure which work sizes suit the OpenCL device, use and remember them")
      ->envname("SQUALL_TUNE");
  add(command, "--tuning", options.tuning, "File with remembered work sizes, or none (the one in the cache folder)")
      ->type_name("FILE");
  add(command, "--out", options.out, "Folder for scene.toml, frames.csv and more")->type_name("DIR");
  add(command, "--trace", options.trace,
      "Write what happened when to FILE, for ui.perfetto.dev or chrome://tracing; recording costs time")
      ->type_name("FILE");
  add(command, "--format", raw.format, "Shape of the JSON: squall or google-benchmark (for its compare.py)")
      ->type_name("NAME");
}

void add_checkpoint_options(CLI::App& command, Options& options) {
  add(command, "--checkpoint", options.checkpoint, "Save the run to FILE at its end, for --restart")->type_name("FILE");
  add(command, "--checkpoint-every", options.checkpoint_every_s, "Also after every S simulated seconds")
      ->check(positive())
      ->type_name("S");
  add(command, "--restart", options.restart,
      "Go on from this checkpoint of the same scene, on any backend, for N more frames or to the scene's end")
      ->type_name("FILE");
}

void add_lists_of_runs(CLI::App& command, Options& options, RawOptions& raw, const char* threads,
                       const char* readbacks) {
  list(add(command, "--backend", raw.backends, "Only these; may be repeated (omp, opencl)"), "NAME[,NAME]");
  add(command, "--device", options.device, "Only OpenCL devices with this index or part of the name")
      ->type_name("DEVICE");
  list(add(command, "--threads", options.threads, threads), "N[,N]")->check(CLI::Range(1, 1024));
  list(add(command, "--readback", raw.readbacks, readbacks), "MODE[,MODE]");
}

}  // namespace squall::app
