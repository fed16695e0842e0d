#pragma once

#include <string>
#include <vector>

#include "harness/results_json.h"

namespace squall::app {

/// What the results of study, sweep or validate in a folder are about.
struct Subject {
  std::string id;    ///< of a scene its hash, of a case its name and that of its scene
  std::string text;  ///< for people
};

/// The subject of a study or sweep.
Subject subject_of(const harness::SceneInfo& scene);
/// One of a validation.
Subject subject_of(const std::string& case_name, const std::string& scene_name, const std::string& scene_hash);

/// Throws InputError if a folder of --out holds results that `command` ("study", "sweep", "validate") would replace by
/// those of something else: of another command, since all write report.html, or about a subject that is none of `mine`.
/// Touches nothing. A file that cannot be read as JSON was never finished, and is nobody's.
void refuse_other_results(const std::string& folder, const std::string& command, const std::vector<Subject>& mine);

/// Throws InputError if runs that a study keeps in the folder are of another scene than `mine`.
void refuse_other_study(const std::string& folder, const Subject& theirs, const Subject& mine);

/// The file in which a study keeps its runs.
inline constexpr const char* k_runs_file = "runs.jsonl";

}  // namespace squall::app
