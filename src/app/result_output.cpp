#include "app/result_output.h"

#include <algorithm>
#include <fstream>
#include <iostream>

#include "app/device_choice.h"
#include "app/exit_codes.h"
#include "app/plans.h"
#include "core/errors.h"

namespace squall::app {

harness::Context context_of(const std::vector<BackendInfo>& backends, const std::vector<harness::Row>& rows) {
  harness::Context context = harness::collect_context();
  for (const auto& row : rows)
    if (row.plan.backend == "opencl" && !context.opencl) {
      context.opencl = device_of(row.plan, backends);
      context.opencl_build_options = row.solver.build_options;
    }
  return context;
}

void write_json(const Options& options, const harness::Json& json) {
  if (options.json.empty()) return;
  const std::string text = harness::json_text(json);
  if (options.json_alone()) {
    std::cout << text << std::flush;
    return;
  }
  std::ofstream file(options.json);
  file << text << std::flush;
  if (!file) throw InputError(options.json + ": cannot write this file; check the folder's rights and free space");
}

void write_result(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends,
                  const std::vector<harness::Row>& rows, const std::optional<harness::Agreement>& agreement) {
  if (options.json.empty()) return;
  const auto context = context_of(backends, rows);
  write_json(options, options.format == Format::google_benchmark
                          ? harness::to_google_benchmark(context, workload.info, rows)
                          : harness::to_json(context, workload.info, rows, agreement));
}

bool keeps_budget(const harness::Row& row, double budget_ms) {
  return row.error.empty() && row.frames > 0 && row.frame_ms.p95 <= budget_ms;
}

int exit_code_of(const Options& options, const std::vector<harness::Row>& rows,
                 const std::optional<harness::Agreement>& agreement) {
  const auto any = [&](auto condition) { return std::any_of(rows.begin(), rows.end(), condition); };
  if (any([](const auto& row) { return row.device_failed; })) return k_exit_device;
  if (any([](const auto& row) { return !row.error.empty(); })) return k_exit_unstable;
  if (agreement && !agreement->agree) return k_exit_disagree;
  if (options.budget_ms && !any([&](const auto& row) { return keeps_budget(row, *options.budget_ms); }))
    return k_exit_budget;
  return k_exit_fine;
}

}  // namespace squall::app
