#include "app/raw_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/exit_codes.h"

namespace squall::app {

namespace {

/// Asking twice for a thread count gives one run.
std::vector<int> without_repeats(const std::vector<int>& values) {
  std::vector<int> result;
  for (const int value : values)
    if (std::find(result.begin(), result.end(), value) == result.end()) result.push_back(value);
  return result;
}

}  // namespace

void understand(const RawOptions& raw, Options& options) {
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

}  // namespace squall::app
