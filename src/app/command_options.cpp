#include "app/command_options.h"

#include "app/checks.h"
#include "app/later_options.h"
#include "app/option_adding.h"
#include "app/option_groups.h"
#include "app/study_options.h"
#include "core/scene_keys.h"

namespace squall::app {

CLI::App* add_run(CLI::App& app, Options& options, RawOptions& raw) {
  CLI::App* run = app.add_subcommand("run", "Run a scene on one backend; frames to disk if asked");
  add_water_options(*run, options, raw);
  add_particles(*run, options);
  add(*run, "--backend", raw.backends, "reference, omp or opencl (omp; opencl with --device)")
      ->expected(1)
      ->type_name("NAME");
  add(*run, "--device", options.device, "OpenCL device: index or part of its name in `squall devices`")
      ->type_name("DEVICE");
  add(*run, "--threads", options.threads, "Threads, or compute units of a CPU device; else all")
      ->expected(1)
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  add(*run, "--readback", raw.readbacks, "none, blocking, pinned, mapped, async or quantized (mapped)")
      ->expected(1)
      ->type_name("MODE");
  add_measuring_options(*run, options, raw);
  add(*run, "--save-every", options.save_every, "With --out: write the particles after every N-th frame")
      ->check(CLI::Range(1, 10'000'000))
      ->type_name("N");
  add_checkpoint_options(*run, options);
  run->add_flag("--print-scene", options.print_scene, "Print the scene as it would run, as a scene file, and stop");
  add_output_options(*run, options);
  add_later_options(*run);
  return run;
}

CLI::App* add_compare(CLI::App& app, Options& options, RawOptions& raw) {
  CLI::App* compare = app.add_subcommand("compare", "Every backend and device side by side, and whether they agree");
  add_water_options(*compare, options, raw);
  add_particles(*compare, options);
  add_lists_of_runs(*compare, options, raw, "Thread counts (omp: 1 and all)", "Only these read-back modes (all)");
  add_measuring_options(*compare, options, raw);
  add_output_options(*compare, options);
  add_later_options(*compare);
  add_later_checkpoints(*compare);
  return compare;
}

CLI::App* add_sweep(CLI::App& app, Options& options, RawOptions& raw) {
  CLI::App* sweep =
      app.add_subcommand("sweep", "Frames per second and speed-up against particles, threads and backend");
  add_water_options(*sweep, options, raw);
  list(add(*sweep, "--particles", options.sizes,
           "Sizes to measure, each the nearest that the scene scales to (doubling from above 1,000 for 2 minutes)"),
       "N[,N]")
      ->check(CLI::Range(std::int64_t{1}, scene_keys::k_max_particles));
  add_lists_of_runs(*sweep, options, raw, "Thread counts (omp: 1, 2, 4, ... and all)",
                    "Read-back modes of opencl (mapped on CPU devices, else pinned)");
  add_solver_options(*sweep, raw);
  add_length_options(*sweep, options);
  add(*sweep, "--budget-ms", options.budget_ms,
      "Search the largest scene whose median frame time keeps this; exit 7 if none does")
      ->check(positive())
      ->type_name("F");
  add(*sweep, "--out", options.out, "Folder for report.html, plots (gnuplot), points.csv and sweep.json")
      ->type_name("DIR");
  add_output_options(*sweep, options);
  add_later_options(*sweep);
  add_later_checkpoints(*sweep);
  return sweep;
}

CLI::App* add_validate(CLI::App& app, Options& options, RawOptions& raw) {
  CLI::App* validate = app.add_subcommand("validate", "Physics against analytic solutions and experiments");
  validate
      ->add_option("case", options.cases,
                   "Case files (TOML), or names of cases that come with squall (all of these; see --list)")
      ->type_name("CASE");
  validate->add_flag("--list", options.list, "List the cases, quantities and formulas there are, and stop");
  validate->add_flag("--quick", options.quick, "Coarser scenes, where the cases name some")->envname("SQUALL_QUICK");
  add(*validate, "--expected", options.expected,
      "The CASE is a scene; hold it against this CSV table: time_s, then a column per quantity or gauge")
      ->type_name("FILE");
  add(*validate, "--tolerance", options.tolerance,
      "With --expected: largest rms error, as a share of a column's largest value")
      ->check(positive())
      ->type_name("F");
  list(add(*validate, "--pressure", raw.pressures, "Only these solvers: mueller, wcsph, dfsph (all of a case)"),
       "NAME[,NAME]");
  list(add(*validate, "--backend", raw.backends,
           "Each of these: omp, opencl, reference (the first that has the solver)"),
       "NAME[,NAME]");
  add(*validate, "--device", options.device, "OpenCL device: index or part of its name in `squall devices`")
      ->type_name("DEVICE");
  add(*validate, "--threads", options.threads, "Threads, or compute units of a CPU device; else all")
      ->expected(1)
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  add_solver_options(*validate, raw);
  add_particles(*validate, options);
  add(*validate, "--dt-max", options.dt_max_s, "Longest sub-step [s]; else the scene's")
      ->check(within(1e-7, 1.0))
      ->type_name("S");
  add(*validate, "--seed", options.seed, "Of the rain (1)")->check(unsigned_number())->type_name("N");
  add(*validate, "--out", options.out, "Folder for report.html, plots (gnuplot), time series and validate.json")
      ->type_name("DIR");
  add_output_options(*validate, options);
  add_later_options(*validate);
  return validate;
}

CLI::App* add_stress(CLI::App& app, Options& options, RawOptions& raw) {
  CLI::App* stress = app.add_subcommand("stress", "The hard cases: what breaks solvers, and whether it breaks these");
  list(add(*stress, "--pressure", raw.pressures, "Only these solvers: mueller, wcsph, dfsph (all)"), "NAME[,NAME]");
  list(add(*stress, "--backend", raw.backends, "Only these; may be repeated (omp, opencl)"), "NAME[,NAME]");
  add(*stress, "--device", options.device, "Only OpenCL devices with this index or part of the name")
      ->type_name("DEVICE");
  list(add(*stress, "--threads", options.threads, "Thread counts (all)"), "N[,N]")->check(CLI::Range(1, 1024));
  add_solver_options(*stress, raw);
  CLI::Option* cases = list(add(*stress, "--case", options.case_numbers, "Only these, by number (all)"), "N[,N]");
  cases->check(CLI::Range(1, 34));
  stress
      ->add_flag("--largest-step", options.largest_step,
                 "Instead of the cases, the largest stable time step per solver, stiffness, viscosity and precision, "
                 "beside theory and what squall takes (omp with one thread)")
      ->excludes(cases);
  stress->add_flag("--quick", options.quick, "Shorter runs, without the longest cases")->envname("SQUALL_QUICK");
  add_output_options(*stress, options);
  add_later_options(*stress);
  return stress;
}

CLI::App* add_study(CLI::App& app, Options& options, RawOptions& raw) {
  CLI::App* study = app.add_subcommand("study", "Speed against error: which settings are worth their time");
  study->add_option("scene", options.scene, "Scene file (TOML)")->required()->type_name("SCENE");
  list(add(*study, "--pressure", raw.pressures, "Only these solvers: mueller, wcsph, dfsph (all)"), "NAME[,NAME]");
  add_particles(*study, options);
  list(add(*study, "--backend", raw.backends, "The first is the base, the others stand beside it (omp, opencl)"),
       "NAME[,NAME]");
  add(*study, "--device", options.device, "OpenCL device: index or part of its name in `squall devices`")
      ->type_name("DEVICE");
  add(*study, "--threads", options.threads, "Threads, or compute units of a CPU device; else all")
      ->expected(1)
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  add(*study, "--simd", raw.simd, "scalar, avx2 or avx512; else the widest there is, and by device")->type_name("NAME");
  add_length_options(*study, options);
  add(*study, "--dt-max", options.dt_max_s, "Longest sub-step [s] of the base; else the scene's")
      ->check(within(1e-7, 1.0))
      ->type_name("S");
  add(*study, "--seed", options.seed, "Of the rain (1)")->check(unsigned_number())->type_name("N");
  add_study_options(*study, raw.study);
  add(*study, "--budget-ms", options.budget_ms,
      "Recommend the most accurate setting whose 95th percentile of frame time keeps this; exit 7 if none does")
      ->check(positive())
      ->type_name("F");
  add(*study, "--out", options.out,
      "Folder for report.html, plots (gnuplot), study.csv, study.json, scenes, and the runs that a later start goes on "
      "from")
      ->type_name("DIR");
  add_output_options(*study, options);
  add_later_options(*study);
  return study;
}

}  // namespace squall::app
