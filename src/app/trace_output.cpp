#include "app/trace_output.h"

#include <fmt/format.h>

#include <fstream>

#include "core/errors.h"
#include "harness/run.h"

namespace squall::app {

std::vector<std::string> write_trace(const Options& options, const std::vector<harness::TracedRun>& runs) {
  if (options.trace.empty()) return {};
  std::ofstream file(options.trace);
  harness::write_trace(file, harness::collect_context(), runs);
  file.flush();
  if (!file) throw InputError(options.trace + ": cannot write this file; check the folder's rights and free space");
  std::vector<std::string> notes{
      "traced: times include the recording, and OpenCL's queues profiled; without --trace they are shorter"};
  for (const auto& run : runs) {
    const std::size_t kept = harness::traced_frames(*run.frames);
    if (kept < run.frames->size())
      notes.push_back(fmt::format("the trace holds the first {} of {} frames of {}: a run's trace ends at {} spans",
                                  kept, run.frames->size(), run.label, harness::k_max_spans));
  }
  return notes;
}

}  // namespace squall::app
