#pragma once

#include "harness/agree/agree.h"

namespace squall::harness {

/// What runs are held against: those of the reference backend, in single and in double precision.
struct Oracle {
  State start;
  Trajectory run;                       ///< single precision
  Trajectory double_run;                ///< from the same start
  std::vector<StartState> starts;       ///< of single steps
  std::vector<OneStep> steps;           ///< in single precision, one for each start
  std::vector<OneStep> double_steps;    ///< likewise
  std::vector<StepErrors> step_errors;  ///< of single from double precision, likewise
};

/// Judges integers and errors of the subject's steps, one for each start of the oracle.
void judge_steps(const Oracle& oracle, const std::vector<OneStep>& steps, SubjectResult& result);

/// Judges the bits of a run, and of one that has other bits and promises none, its first frame: by as much as rounding
/// explains. Fills hashes, growth and substeps.
void judge_run(const Oracle& oracle, const Trajectory& run, const Scene& scene, SubjectResult& result);

/// Judges the long run of a subject with other bits by observables.
void judge_observables(const std::vector<ObservedDistance>& observed, SubjectResult& result);

}  // namespace squall::harness
