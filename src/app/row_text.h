#pragma once

#include <string>
#include <vector>

#include "harness/row.h"

namespace squall::app {

/// One run as a block of lines for people.
std::string run_text(const harness::Row& row);

/// What the water did, in one line: how dense, what was put back, how the energy changed.
std::string water_text(const harness::Row& row);

/// Milliseconds of each phase per frame, a line per kind of run; empty if no row has phases.
std::string phases_text(const std::vector<harness::Row>& rows);

}  // namespace squall::app
