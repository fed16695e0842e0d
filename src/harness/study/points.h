#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"
#include "harness/row.h"
#include "harness/study/record.h"

namespace squall::harness {

/// What a study changes, one thing at a time, from the scene as it is written.
enum class StudyAxis { step, tolerance, ratio, spacing, precision, backend };

const char* to_string(StudyAxis axis);
const std::vector<StudyAxis>& study_axes();

/// How far each of them is taken. Factors are of what the scene says.
struct StudyRanges {
  std::vector<double> step;                ///< of cfl and dt_max_s, together
  std::vector<double> tolerance;           ///< of dfsph's tolerances
  std::vector<double> ratio;               ///< support ratios themselves
  std::vector<double> spacing;             ///< of the number of particles
  std::vector<double> spacing_steps{1.0};  ///< step factors at each of these
  int perturbed = 3;                       ///< perturbed starts of each model
  int repeats = 3;                         ///< times that each point is timed
};
StudyRanges quick_ranges();
StudyRanges full_ranges();

/// Pressure solver, spacing and support ratio: what stays the same where only the step, the tolerance, the precision or
/// the backend differs. `scene` has the scene's own step and tolerance.
struct StudyModel {
  std::string name;
  Pressure pressure = Pressure::wcsph;
  Scene scene;
  bool is_base = false;  ///< spacing and support ratio as the scene says
};

/// One setting that is timed and judged.
struct StudyPoint {
  std::string name;
  StudyAxis axis = StudyAxis::step;
  std::size_t model = 0;
  double step_factor = 1.0, tolerance_factor = 1.0;
  StudyRun run;
  std::vector<std::string> overrides;  ///< "[solver] cfl = 0.2": how its scene differs from the study's
};

/// Everything that a study can be asked to measure.
struct StudySubjects {
  Scene scene;
  std::vector<Pressure> pressures;
  std::vector<RunPlan> plans;   ///< the first is the base; others, of other backends and precisions, stand beside it
  RunPlan double_plan;          ///< what computes in double: references and perturbed starts
  std::vector<StudyAxis> axes;  ///< those to change
  StudyRanges ranges;
};

struct StudyPoints {
  std::vector<StudyModel> models;
  std::vector<StudyPoint> points;
  std::vector<std::string> notes;  ///< what was left out, and why
};

/// The settings to measure. What a scene cannot be changed to is left out with a note.
StudyPoints make_points(const StudySubjects& subjects);

/// The model's reference: double, dfsph's tolerances as tight as a scene may have them, every sub-step at most an
/// eighth of `finest_dt_s`, the smallest that a point of the model took; `most_substeps` is the most that such a point
/// took in a frame: frames become shorter by a whole number where an eighth would not fit into them.
StudyRun reference_run(const StudySubjects& subjects, const StudyPoints& points, std::size_t model, double finest_dt_s,
                       int most_substeps);

/// Perturbed starts 1..n of the model in double, and 0, the one they perturb. Empty without particles at the start.
std::vector<StudyRun> noise_runs(const StudySubjects& subjects, const StudyPoints& points, std::size_t model);

/// Lines of a scene file that differ: "[solver] cfl = 0.2".
std::vector<std::string> overrides_between(const Scene& from, const Scene& to);

}  // namespace squall::harness
