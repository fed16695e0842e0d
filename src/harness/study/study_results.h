#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "harness/results_json.h"
#include "harness/study/findings.h"

namespace squall::harness {

/// What gives a run again, by hand.
struct StudyCommand {
  std::string command;     ///< "squall run ..."
  std::string scene_file;  ///< the scene that it names, written beside the results; empty if none was written
};

/// A study with what is needed to read it.
struct StudyResult {
  Context context;
  SceneInfo scene;
  StudySubjects subjects;
  StudyQuestion question;
  StudyRuns runs;
  StudyFindings findings;
  std::vector<StudyCommand> point_commands;      ///< as the points
  std::vector<StudyCommand> reference_commands;  ///< as the models; without command where there is no reference
  std::vector<std::string> notes;

  const Record* first_record(std::size_t point) const {
    return runs.records[point].empty() ? nullptr : runs.records[point].front();
  }
  double simulated_s() const;  ///< of every run
  /// The error that points are ranked by; null if the point has none.
  const ErrorFinding* ranked_error(std::size_t point) const;
};

/// {schema, context, scene, measured, question, points, models, orders, front, recommendation, notes}: docs/results.md.
Json to_json(const StudyResult& result);

/// study.csv: a line per point.
void write_study_csv(std::ostream& out, const StudyResult& result);

/// What the study says, a sentence each: the front, the cheapest within max_error, the best within budget_ms.
std::vector<std::string> recommendations(const StudyResult& result);

}  // namespace squall::harness
