#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "app/workload.h"
#include "backends.h"
#include "harness/agreement.h"
#include "harness/row.h"

namespace squall::app {

/// Writes JSON where --json asks for it, if it does. Throws InputError for a file that cannot be written.
void write_json(const Options& options, const harness::Json& json);

/// Where and with what the rows were measured.
harness::Context context_of(const std::vector<BackendInfo>& backends, const std::vector<harness::Row>& rows);

/// The result in the shape of --format, where --json asks for it.
void write_result(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends,
                  const std::vector<harness::Row>& rows, const std::optional<harness::Agreement>& agreement);

/// The exit code that rows ask for: a failed device, then an unstable run, then disagreement, then a budget no row
/// keeps.
int exit_code_of(const Options& options, const std::vector<harness::Row>& rows,
                 const std::optional<harness::Agreement>& agreement);

/// Whether the row's 95th percentile of frame time is within the budget.
bool keeps_budget(const harness::Row& row, double budget_ms);

}  // namespace squall::app
