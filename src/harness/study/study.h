#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/study/errors.h"
#include "harness/study/points.h"
#include "harness/study/record.h"

namespace squall::harness {

/// Runs that are done, by key. Those of an earlier start of the study are put in before it begins.
class StudyRecords {
 public:
  /// `keep` is called with every record that is added by run_study().
  explicit StudyRecords(std::function<void(const Record&)> keep = {}) : keep_(std::move(keep)) {}

  void put(Record record);  ///< without keeping it again
  void add(Record record);
  const Record* find(const std::string& key) const;
  std::size_t size() const { return records_.size(); }

 private:
  std::map<std::string, Record> records_;
  std::function<void(const Record&)> keep_;
};

/// What ran of a model beside its points. Runs that were not carried out have no record.
struct ModelRuns {
  std::optional<StudyRun> reference;
  const Record* reference_record = nullptr;
  std::vector<StudyRun> noise;
  std::vector<const Record*> noise_records;  ///< those there are: the unperturbed run first
  std::string problem;                       ///< why there is no reference
};

/// All runs of a study, done or not.
struct StudyRuns {
  StudyPoints points;
  std::vector<std::vector<const Record*>> records;  ///< of each point: its timings so far, the first with its series
  std::vector<ModelRuns> models;
  std::size_t reused = 0;  ///< runs that were there before
  bool interrupted = false;
};

struct StudyProgress {
  std::string what;  ///< "wcsph, step x2"
  double share = 0.0;
  double left_s = 0.0;
};

/// Called after every frame; false ends the study with the runs done so far.
using AfterStudyFrame = std::function<bool(const StudyProgress& progress)>;

/// Carries out what is not among `records` yet: every point, then the perturbed starts and the reference of every
/// model, then the points again as often as they are to be timed, in turn. `records` must outlive the result.
/// Throws InputError for subjects without a pressure solver, a plan or frames.
StudyRuns run_study(const StudySubjects& subjects, const Context& context, const StudySolverFactory& make,
                    StudyRecords& records, const AfterStudyFrame& after_frame = {});

}  // namespace squall::harness
