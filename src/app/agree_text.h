#pragma once

#include <string>
#include <vector>

#include "app/workload.h"
#include "backends.h"
#include "harness/agree/agree.h"
#include "harness/context.h"

namespace squall::app {

/// The result of `squall agree` as one block of plain text, to be read and to be pasted into a report: versions,
/// devices and what they promise, a line per run, where runs part, the verdict.
std::string agree_text(const Workload& workload, const harness::Context& context,
                       const std::vector<BackendInfo>& backends, const harness::AgreeResult& result);

}  // namespace squall::app
