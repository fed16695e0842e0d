#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/stress/stress.h"

/// The largest stable time step of every pressure solver, found by bisection, beside what theory says of it and beside
/// the step that squall takes (docs/stress.md).
namespace squall::harness {

/// What one search is about.
struct StepSetting {
  StressSubject subject;    ///< with the pressure solver and the precision
  double signal_m_s = 0.0;  ///< wcsph: speed of sound; mueller: root of the stiffness; 0 for dfsph
  double viscosity_m2_s = 0.0;
};

/// Time steps [s] beyond which theory expects trouble, each infinite where there is nothing to bound it.
struct StepTheory {
  double sound_s = 0.0;    ///< 2/omega of the fastest wave of the lattice
  double viscous_s = 0.0;  ///< 2/lambda of the mode that viscosity, artificial viscosity included, damps hardest
  double force_s = 0.0;    ///< sqrt(dx/g)/4: a step in which gravity moves a particle by dx/16
  double motion_s = 0.0;   ///< dx/sqrt(2 g D): a step in which the fastest water moves by a spacing
  double smallest() const;
  const char* smallest_name() const;  ///< "sound", "viscosity", "force" or "motion"
};

/// What a search found.
struct StepResult {
  StepSetting setting;
  StepTheory theory;
  double largest_s = 0.0;    ///< 0: even the shortest that was tried is not stable
  bool at_end = false;       ///< the longest that was tried is still stable
  std::string breaks;        ///< what goes wrong at the shortest step that is not stable, or, where none is, at an
                             ///< eighth of squall's whatever energy it gains; empty if none was met
  double taken_s = 0.0;      ///< the longest sub-step that squall plans by itself
  std::string taken_breaks;  ///< what goes wrong with squall's own steps; empty if nothing does
  /// Energy that comes from nowhere at an eighth of squall's step, in water's height above the floor, where that is
  /// more than what is allowed; else 0. It is the model's, not the step's; twice as much is allowed then.
  double gain_anyway = 0.0;
  double wall_s = 0.0;

  double of_theory() const { return largest_s / theory.smallest(); }
  double margin() const { return largest_s / taken_s; }  ///< > 1: that many times longer would still be stable
  /// squall's own steps are unstable although a shorter one is not: a defect.
  bool is_defect() const { return !taken_breaks.empty() && largest_s > 0.0; }
};

/// The settings to search for each subject: slow and fast sound; no viscosity, a scene's, as much as makes squall's
/// own bounds of sound and of viscosity equal, and more. `quick`: slow sound alone, without the third.
std::vector<StepSetting> step_settings(const std::vector<StressSubject>& subjects, bool quick);

/// Scenes that are run at a step: still water in a tank, pushed about a little, and a small collapse.
std::vector<Scene> step_scenes(const StepSetting& setting, bool quick);

StepTheory step_theory(const StepSetting& setting, bool quick);

inline constexpr double k_allowed_gain = 0.05;  ///< of energy, in water's height above the floor

/// What came of running the scenes at one step.
struct StepTrial {
  bool ended = false;      ///< by `go_on`
  std::string trouble;     ///< what went wrong first; empty if nothing did
  double longest_s = 0.0;  ///< sub-step that there was
  double gain = 0.0;       ///< largest energy above the start's, in water's height above the floor
};

/// Runs the scenes at a fixed step, or, for 0, as squall plans them, for at least half a second and 300 sub-steps
/// (`quick`: 0.1 s, 60). Nothing goes wrong if throughout
///   every number was finite and no particle was lost,
///   the energy stayed below the start's and `allowed_gain` times the water's height above the floor,
///   nobody was faster than twice a fall from the top of the water and the fastest start,
///   the mean over-density stayed below a tenth and twice what the stiffness allows at the floor.
/// `go_on` is asked after every frame.
StepTrial try_step(const StepSetting& setting, const StressFactory& make, double step_s, bool quick,
                   double allowed_gain, const std::function<bool()>& go_on);

/// Called now and then with the share done of this search, about; false ends it.
using StepProgress = std::function<bool(double share)>;

/// Searches: from squall's own step on doubled or halved until one is stable and the other is not, up to 64 times and
/// down to a 32nd, then bisected to 2 % (`quick`: 10 %). Where every step gains energy, again with twice the gain that
/// the model has at short steps. nullopt if `progress` ended it. An error of the machine's (DeviceError) goes on to the
/// caller.
std::optional<StepResult> find_largest_step(const StepSetting& setting, const StressFactory& make, bool quick,
                                            const StepProgress& progress);

}  // namespace squall::harness
