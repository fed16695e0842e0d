#include <exception>
#include <iostream>
#include <new>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/option_parser.h"
#include "app/standard_streams.h"
#include "core/errors.h"

namespace {

using namespace squall::app;

int run_command(const Options& options) {
  switch (options.command) {
    case Command::devices:
      return command_devices(options);
    case Command::run:
      return command_run(options);
    case Command::compare:
      return command_compare(options);
    case Command::sweep:
      return command_sweep(options);
    case Command::agree:
      return command_agree(options);
    case Command::study:
      return command_study(options);
    case Command::validate:
      return command_validate(options);
    case Command::stress:
      return command_stress(options);
  }
  return k_exit_internal;
}

int parse_and_run(int argc, char** argv) {
  const auto options = parse_options(argc, argv);
  const int code = options ? run_command(*options) : k_exit_fine;
  finish_stdout();
  return code;
}

int complain(const char* text, int code) {
  std::cerr << "squall: " << text << "\n";
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    reserve_standard_streams();
    return parse_and_run(argc, argv);
  } catch (const UsageError& error) {
    return complain((std::string(error.what()) + "\nsee squall --help, or squall COMMAND --help").c_str(),
                    k_exit_usage);
  } catch (const squall::InputError& error) {
    return complain(error.what(), k_exit_input);
  } catch (const squall::DeviceError& error) {
    return complain(error.what(), k_exit_device);
  } catch (const std::bad_alloc&) {
    return complain("out of memory; use fewer particles, or close what else needs memory", k_exit_device);
  } catch (const std::exception& error) {
    return complain((std::string("internal error: ") + error.what()).c_str(), k_exit_internal);
  }
}
