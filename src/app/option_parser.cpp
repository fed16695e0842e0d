#include "app/option_parser.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>
#include <utility>

#include "app/agree_options.h"
#include "app/command_options.h"
#include "app/contradictions.h"
#include "app/exit_codes.h"
#include "app/later_options.h"
#include "app/notes.h"
#include "app/option_groups.h"
#include "app/raw_options.h"
#include "build_info.h"

namespace squall::app {

namespace {

constexpr const char* k_later_commands[] = {"cost", "view"};

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
  RawOptions raw;
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
