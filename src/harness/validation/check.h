#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/validation/case.h"
#include "harness/validation/formulas.h"
#include "harness/validation/series.h"

namespace squall::harness {

/// Measured against expected at one time, in the quantity's unit; NaN where the quantity has no value.
struct ComparedPoint {
  double time_s = 0.0, measured = 0.0, expected = 0.0;
};

/// What a check found in a run.
struct Finding {
  bool passed = false;
  std::string problem;        ///< why there is no error to judge; empty if there is one. Such a check has failed
  bool lacks_values = false;  ///< nothing was measured where something should be: no failure that a case may expect
  double error = 0.0, tolerance = 0.0;
  std::optional<double> shift_s;  ///< measured(t + shift) is held against expected(t)
  ComparedPoint worst;            ///< where they are furthest apart, or the first without a value; of a slope or
                                  ///< period, these themselves
  std::vector<ComparedPoint> points;
};

/// Whether a time [s] lies between from_s and to_s of a check.
bool is_in(const Check& check, double time_s);

/// Tolerance of a check at a spacing [m], in the unit of its error.
double tolerance_of(const Check& check, double spacing_m);

/// Unit of a check's error: the quantity's, or "1" for a share.
std::string error_unit(const Check& check, const std::string& quantity_unit);

/// What is expected at all times; empty for tables, and for formula "start", which needs the run.
Curve expected_curve(const Check& check, const Scene& scene);

/// Holds a run's series against a check. `scene` as it ran.
Finding judge(const Check& check, const Scene& scene, const TimeSeries& series);

}  // namespace squall::harness
