#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/scene.h"
#include "harness/validation/series.h"

namespace squall::harness {

/// What a study judges water by. Errors are differences of this quantity over its scale: pure numbers, so that those of
/// different quantities and spacings can stand side by side (docs/study.md).
struct StudyObservable {
  std::string name;         ///< with its unit
  std::string scale;        ///< what a difference is divided by, for people
  bool combined = false;    ///< part of the combined error
  bool exact_zero = false;  ///< its true value is 0, so that it is an error without any reference
};

const std::vector<StudyObservable>& study_observables();

/// Name of the error that is made of several observables: the root mean square of those marked `combined`.
inline constexpr const char* k_combined_error = "combined";

/// Names of all errors there are: combined, then the observables.
std::vector<std::string> error_names();

/// Scale of each observable in a scene: depth D, energy M v^2/2 and pressure rho0 v^2/2 of all its water at the speed
/// v = sqrt(2 g D) of a fall through D.
std::map<std::string, double> observable_scales(const Scene& scene);

/// Every observable at each of these times [s]; NaN where it has no value. The floor's pressure is a mean over the
/// frame that ends there.
std::map<std::string, std::vector<double>> sample_observables(const Scene& scene, const TimeSeries& series,
                                                              const std::vector<double>& times, double frame_s);

}  // namespace squall::harness
