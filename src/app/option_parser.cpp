#include "app/option_parser.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "app/agree_options.h"
#include "app/checks.h"
#include "app/contradictions.h"
#include "app/exit_codes.h"
#include "app/notes.h"
#include "app/option_adding.h"
#include "app/study_options.h"
#include "build_info.h"
#include "core/scene_keys.h"

namespace squall::app {

namespace {

/// The command line as texts, before values are understood.
struct Raw {
  std::vector<std::string> backends, readbacks, pressures;
  std::string simd, precision, pressure, format = "squall";
  RawStudyOptions study;
};

constexpr const char* k_later_commands[] = {"cost", "view"};
constexpr const char* k_later_options[] = {"--fast-math", "--tolerance", "--max-error"};
constexpr const char* k_checkpoint_options[] = {"--checkpoint", "--checkpoint-every", "--restart"};

void add_later_options(CLI::App& command) {
  for (const char* name : k_later_options) {
    if (command.get_option_no_throw(name) != nullptr) continue;  // this command has it
    // An empty group hides the option from --help.
    command.add_option(name)->expected(0, 1)->group("")->envname(variable_of(name));
  }
}

/// `compare` and `sweep` have several runs; a checkpoint holds one.
void add_later_checkpoints(CLI::App& command) {
  for (const char* name : k_checkpoint_options) command.add_option(name)->expected(0, 1)->group("");
}

void refuse_later_checkpoints(const CLI::App& command) {
  for (const char* name : k_checkpoint_options)
    if (command.get_option(name)->count() > 0)
      throw UsageError(fmt::format("{} of {} is not in this version; run has it", name, command.get_name()));
}

void refuse_later_options(const CLI::App& command) {
  for (const char* name : k_later_options)
    if (const auto* option = command.get_option(name); option->get_group().empty() && option->count() > 0)
      throw UsageError(fmt::format("{} is not in this version", name));
}

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

void add_water_options(CLI::App& command, Options& options, Raw& raw) {
  command.add_option("scene", options.scene, "Scene file (TOML)")->required()->type_name("SCENE");
  add_pressure(command, raw.pressure);
  add(command, "--dt-max", options.dt_max_s, "Longest sub-step [s]; else the scene's")
      ->check(within(1e-7, 1.0))
      ->type_name("S");
  add(command, "--seed", options.seed, "Of the rain (1)")->check(unsigned_number())->type_name("N");
}

void add_solver_options(CLI::App& command, Raw& raw) {
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

void add_measuring_options(CLI::App& command, Options& options, Raw& raw) {
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

CLI::App* add_run(CLI::App& app, Options& options, Raw& raw) {
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

/// Which runs stand side by side; what is taken where nothing is asked for differs between commands.
void add_lists_of_runs(CLI::App& command, Options& options, Raw& raw, const char* threads, const char* readbacks) {
  list(add(command, "--backend", raw.backends, "Only these; may be repeated (omp, opencl)"), "NAME[,NAME]");
  add(command, "--device", options.device, "Only OpenCL devices with this index or part of the name")
      ->type_name("DEVICE");
  list(add(command, "--threads", options.threads, threads), "N[,N]")->check(CLI::Range(1, 1024));
  list(add(command, "--readback", raw.readbacks, readbacks), "MODE[,MODE]");
}

CLI::App* add_compare(CLI::App& app, Options& options, Raw& raw) {
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

CLI::App* add_sweep(CLI::App& app, Options& options, Raw& raw) {
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

CLI::App* add_validate(CLI::App& app, Options& options, Raw& raw) {
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

CLI::App* add_stress(CLI::App& app, Options& options, Raw& raw) {
  CLI::App* stress = app.add_subcommand("stress", "The hard cases: what breaks solvers, and whether it breaks these");
  list(add(*stress, "--pressure", raw.pressures, "Only these solvers: mueller, wcsph, dfsph (all)"), "NAME[,NAME]");
  list(add(*stress, "--backend", raw.backends, "Only these; may be repeated (omp, opencl)"), "NAME[,NAME]");
  add(*stress, "--device", options.device, "Only OpenCL devices with this index or part of the name")
      ->type_name("DEVICE");
  list(add(*stress, "--threads", options.threads, "Thread counts (all)"), "N[,N]")->check(CLI::Range(1, 1024));
  add_solver_options(*stress, raw);
  list(add(*stress, "--case", options.case_numbers, "Only these, by number (all)"), "N[,N]")->check(CLI::Range(1, 34));
  stress->add_flag("--quick", options.quick, "Shorter runs, without the longest cases")->envname("SQUALL_QUICK");
  add_output_options(*stress, options);
  add_later_options(*stress);
  return stress;
}

CLI::App* add_study(CLI::App& app, Options& options, Raw& raw) {
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

bool on_command_line(int argc, char** argv, const std::string& name) {
  return std::any_of(argv, argv + argc,
                     [&](const std::string& text) { return text == name || text.rfind(name + "=", 0) == 0; });
}

/// --frames and --seconds say the same thing: a flag beats the other's variable, two of a kind contradict each other.
void settle_length(int argc, char** argv, Options& options) {
  if (!options.frames || !options.seconds) return;
  const bool frames = on_command_line(argc, argv, "--frames"), seconds = on_command_line(argc, argv, "--seconds");
  if (frames == seconds) throw UsageError("--frames and --seconds both set the length of the run; give one of them");
  if (frames)
    options.seconds.reset();
  else
    options.frames.reset();
}

/// Asking twice for a thread count gives one run.
std::vector<int> without_repeats(const std::vector<int>& values) {
  std::vector<int> result;
  for (const int value : values)
    if (std::find(result.begin(), result.end(), value) == result.end()) result.push_back(value);
  return result;
}

void understand(const Raw& raw, Options& options) {
  for (const auto& text : raw.backends) options.backends.push_back(parse_backend(text));
  options.threads = without_repeats(options.threads);
  for (const auto& text : raw.pressures) options.pressures.push_back(parse_pressure(text));
  for (const auto& text : raw.readbacks) options.readbacks.push_back(parse_readback(text));
  if (!raw.simd.empty()) options.simd = parse_simd(raw.simd);
  if (!raw.precision.empty()) options.precision = parse_precision(raw.precision);
  if (!raw.pressure.empty()) options.pressure = parse_pressure(raw.pressure);
  options.study = understand(raw.study);
  if (raw.format == "google-benchmark")
    options.format = Format::google_benchmark;
  else if (raw.format != "squall")
    throw UsageError(fmt::format("--format '{}' is unknown; there are squall, google-benchmark", raw.format));
  if (options.format != Format::squall && options.json.empty()) options.json = "-";
  if (options.expected.empty() == options.tolerance.has_value())
    throw UsageError("--expected and --tolerance belong together: a table, and how far off the water may be");
  if (!options.expected.empty() && options.cases.size() != 1)
    throw UsageError("--expected holds one scene against a table; name one scene");
  if (options.trace == "-") throw UsageError("--trace writes to a file, not to stdout; give it a name");
  if (options.checkpoint == "-" || options.restart == "-")
    throw UsageError("--checkpoint and --restart take files, not stdout or stdin; give them names");
  if (options.save_every > 0 && options.out.empty())
    throw UsageError("--save-every needs a folder to write to; add --out DIR");
  if (options.checkpoint_every_s && options.checkpoint.empty())
    throw UsageError("--checkpoint-every needs a file to write to; add --checkpoint FILE");
}

/// The parser would only say that a command is required.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2)
    throw UsageError("a command is missing; there are devices, run, compare, sweep, agree, study, validate, stress");
  const std::string name = argv[1];
  const auto commands = app.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  if (name.rfind('-', 0) != 0 && commands.empty())
    throw UsageError(fmt::format(
        "the command '{}' is unknown; there are devices, run, compare, sweep, agree, study, validate, stress", name));
}

/// The parser would read variables for the commands that are not carried out, too, into the same options.
void ignore_variables_of_others(CLI::App& app, const std::string& name) {
  for (CLI::App* command : app.get_subcommands([&](const CLI::App* command) { return command->get_name() != name; }))
    for (CLI::Option* option : command->get_options()) option->envname("");
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv) {
  CLI::App app("squall: does this water fit your milliseconds, on the CPU or on OpenCL, and is it the same water?",
               "squall");
  app.set_version_flag("--version", fmt::format("squall {} ({})", k_squall_version, k_git_revision));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 fine, 1 internal error, 2 usage, 3 scene, checkpoint or output file, 4 device,\n"
      "5 results disagree or a verdict is unexpected, 6 unstable or not finite, 7 budget exceeded, 130 interrupted, "
      "143 terminated.\n"
      "Every option --some-name that takes a value has a variable SQUALL_SOME_NAME, and so have --quiet, --quick and "
      "--tune; the option wins, and the variable wins over the scene.");
  Options options;
  Raw raw;
  CLI::App* devices = app.add_subcommand("devices", "What can run here, and why something cannot");
  add_output_options(*devices, options);
  CLI::App* run = add_run(app, options, raw);
  CLI::App* compare = add_compare(app, options, raw);
  CLI::App* sweep = add_sweep(app, options, raw);
  AgreeTexts agree_texts;
  CLI::App* agree = add_agree(app, options, agree_texts);
  add_output_options(*agree, options);
  add_later_options(*agree);
  CLI::App* study = add_study(app, options, raw);
  CLI::App* validate = add_validate(app, options, raw);
  CLI::App* stress = add_stress(app, options, raw);
  for (const char* name : k_later_commands)
    app.add_subcommand(name, "not in this version")->group("")->allow_extras()->set_help_flag();
  check_command(app, argc, argv);
  ignore_variables_of_others(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw UsageError(error.what());
    app.exit(error, std::cout, std::cerr);
    return std::nullopt;
  }
  for (const char* name : k_later_commands)
    if (app.got_subcommand(name)) throw UsageError(fmt::format("the command '{}' is not in this version", name));
  const std::pair<CLI::App*, Command> commands[] = {
      {devices, Command::devices}, {run, Command::run},     {compare, Command::compare},   {sweep, Command::sweep},
      {agree, Command::agree},     {study, Command::study}, {validate, Command::validate}, {stress, Command::stress}};
  for (const auto& [command, name] : commands) {
    if (!*command) continue;
    options.command = name;
    if (name != Command::devices) refuse_later_options(*command);
    if (name == Command::compare || name == Command::sweep) refuse_later_checkpoints(*command);
  }
  understand(agree_texts, options);
  understand(raw, options);
  settle_length(argc, argv, options);
  const auto is_flag = [&](const std::string& option) { return on_command_line(argc, argv, option); };
  print_notes(drop_contradicted_variables(is_flag, options), options.quiet);
  check_contradictions(options);
  return options;
}

}  // namespace squall::app
