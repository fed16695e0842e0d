#include "app/agree_options.h"

#include "app/option_adding.h"
#include "core/scene_keys.h"

namespace squall::app {

CLI::App* add_agree(CLI::App& app, Options& options, AgreeTexts& texts) {
  CLI::App* agree = app.add_subcommand(
      "agree", "Whether every backend, device, thread count and vector width computes the same water, level by level");
  agree->add_option("scene", options.scene, "Scene file (TOML)")->required()->type_name("SCENE");
  add_pressure(*agree, texts.pressure);
  add(*agree, "--particles", options.particles, "Change the spacing so that about N particles result (at most 1,000)")
      ->check(CLI::Range(std::int64_t{1}, scene_keys::k_max_particles))
      ->type_name("N");
  list(add(*agree, "--backend", texts.backends, "Only these; may be repeated (omp, opencl; reference always judges)"),
       "NAME[,NAME]");
  add(*agree, "--device", options.device, "Only OpenCL devices with this index or part of the name")
      ->type_name("DEVICE");
  list(add(*agree, "--threads", options.threads, "Thread counts of omp and of CPU devices (1, 3 and all)"), "N[,N]")
      ->check(CLI::Range(1, 1024));
  list(add(*agree, "--simd", texts.simds, "Widths of vectors: scalar, avx2, avx512 (all that the machine has)"),
       "NAME[,NAME]");
  add(*agree, "--frames", options.frames, "Frames of the long run (60)")
      ->check(CLI::Range(1, 10'000'000))
      ->type_name("N");
  add(*agree, "--seconds", options.seconds, "The same as simulated time [s]")->check(positive())->type_name("S");
  add(*agree, "--dt-max", options.dt_max_s, "Longest sub-step [s]; else the scene's")
      ->check(within(1e-7, 1.0))
      ->type_name("S");
  add(*agree, "--seed", options.seed, "Of the rain (1)")->check(unsigned_number())->type_name("N");
  return agree;
}

void understand(const AgreeTexts& texts, Options& options) {
  for (const auto& text : texts.backends) options.backends.push_back(parse_backend(text));
  for (const auto& text : texts.simds) options.simds.push_back(parse_simd(text));
  if (!texts.pressure.empty()) options.pressure = parse_pressure(texts.pressure);
}

}  // namespace squall::app
