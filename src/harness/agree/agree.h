#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/agree/difference.h"
#include "harness/agree/noise_floor.h"
#include "harness/agree/one_step.h"
#include "harness/agree/trajectory.h"
#include "harness/run.h"

namespace squall::harness {

/// One way to run the scene: backend, device, threads, vectors. `plan.strict` says whether it promises bits.
struct Subject {
  RunPlan plan;
  std::string lacks;  ///< guarantees its device lacks, for the reader; empty where it promises bits
};

struct AgreeSettings {
  int frames = 60;   ///< of the long run
  int horizon = 10;  ///< frames whose states are held against double precision one by one
  int members = 5;   ///< perturbed runs that tell the noise floor
};

/// A level's verdict on one subject.
enum class Verdict {
  same,       ///< to the last bit
  within,     ///< differs, by no more than what was to be expected of it
  differs,    ///< differs where bits are promised, or by more than can be explained
  not_tried,  ///< `note` says why
};

/// One step from one of the start states.
struct StepCheck {
  std::string start;
  IntegerCheck integers;  ///< against the reference in single precision
  StepErrors errors;      ///< against the reference in double precision
};

struct SubjectResult {
  Subject subject;
  SolverInfo solver;
  std::string error;  ///< a device that failed, or why its run ended early
  bool device_failed = false;
  std::int64_t substeps = 0;

  std::vector<std::uint64_t> hashes;  ///< after each frame of the long run
  Verdict integers = Verdict::not_tried, one_step = Verdict::not_tried, bits = Verdict::not_tried;
  Verdict again = Verdict::not_tried, restart = Verdict::not_tried, hand_over = Verdict::not_tried;
  Verdict long_run = Verdict::not_tried;
  std::vector<StepCheck> steps;
  std::vector<Distance> growth;            ///< from the first subject, per frame; empty where the bits are the same
  std::vector<ObservedDistance> observed;  ///< likewise, over the long run
  std::vector<std::string> notes;          ///< why something differs or was not tried

  /// What counts against it.
  bool agrees() const;
};

/// Two subjects. Pairs that differ name where.
struct PairResult {
  std::size_t first = 0, second = 0;   ///< indices of subjects
  bool promised = false;               ///< both promise bits
  bool bitwise = false;                ///< same hash after every frame
  std::optional<std::uint64_t> frame;  ///< index of the first that ends differently
  std::optional<FirstDifference> difference;
};

struct AgreeResult {
  AgreeSettings settings;
  std::vector<SubjectResult> subjects;  ///< the first is the reference in single precision, which all are held against
  std::vector<PairResult> pairs;
  std::vector<Distance> double_growth;  ///< of single from double precision, per frame
  std::vector<ObservedDistance> double_observed;
  std::size_t most_particles = 0;
  bool interrupted = false;

  bool agree() const;
  bool device_failed() const;
};

/// How much of all frames is done, from 0 to 1, and what is being done; false ends the work with what there is.
using AgreeProgress = std::function<bool(double share, const std::string& doing)>;

/// Level by level: integers of single steps exact, their densities, pressures and forces in ulps against double; the
/// growth of differences over a short horizon; the long run bit by bit, and where it is not the same by observables
/// within the noise floor of perturbed runs; run to run; restart from a checkpoint's bytes, and hand-over from the
/// subject before. Where bits differ, the first sub-step and particle. Subjects run one after the other. The first of
/// `subjects` must be the reference backend in single precision, by which all others are judged. A device that fails is
/// noted and the others go on. Throws InputError for no frames or no subjects.
AgreeResult agree(const SolverFactory& make, const std::vector<Subject>& subjects, const AgreeSettings& settings,
                  const AgreeProgress& progress);

}  // namespace squall::harness
