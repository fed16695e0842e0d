#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "harness/study/findings.h"

namespace squall::harness {

/// Throws InputError for a scene that has no particle in its first `frames` frames: no observable has a value there.
/// Says which, and what the scene needs.
void require_water(const Scene& scene, int frames);

/// Which observables of the error that settings are ranked by have no value in any run, or not at all output times, and
/// why; a sentence each. Empty if nothing ran.
std::vector<std::string> observable_gaps(const StudyRuns& runs, const StudyQuestion& question);

/// Why a run has no such error against a reference (null: there is none); empty if it has one.
std::string missing_error(const Record& record, const Record* reference, const std::string& error);

}  // namespace squall::harness
