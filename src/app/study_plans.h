#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/workload.h"
#include "backends.h"
#include "harness/study/study.h"

namespace squall::app {

/// What a study measures, and what was left out of it, one sentence each.
struct StudyPlan {
  harness::StudySubjects subjects;
  std::vector<std::string> left_out;
};

/// The base of a study is the first backend asked for, else omp, with all threads or as many as asked for; beside it
/// stand the other backends and the base's in double. Throws like plan_run().
StudyPlan plan_study(const Options& options, const Workload& workload, const std::vector<BackendInfo>& backends);

/// The command that runs this again from the scene file `scene`.
std::string command_of(const harness::StudyRun& run, const std::string& scene);

}  // namespace squall::app
