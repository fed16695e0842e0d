#pragma once

#include <string>
#include <vector>

#include "harness/row.h"

namespace squall::app {

/// One run as a block of lines for people.
std::string run_text(const harness::Row& row);

/// That water is denser than asked for, for stderr where stdout holds no text: a sentence for the first of the rows of
/// which the same is to be said.
std::vector<std::string> water_notes(const std::vector<harness::Row>& rows);

/// What the water did, in one line: how dense, what was put back, how the energy changed. Of dfsph a second
/// one, what its solves took, and warnings if the water is denser than asked for.
std::string water_text(const harness::Row& row);

/// Milliseconds of each phase per frame, a line per kind of run; empty if no row has phases.
std::string phases_text(const std::vector<harness::Row>& rows);

}  // namespace squall::app
