#pragma once

#include <vector>

#include "harness/validation/check.h"

namespace squall::harness {

/// Measured less expected, in the unit of the check's error; not finite where that is a share of 0.
double point_error(const Check& check, const ComparedPoint& point);

/// Root mean square of point_error().
double rms_error(const Check& check, const std::vector<ComparedPoint>& points);

/// Finds the check's error over finding.points, of which there is at least one and none lacks a value, and where they
/// are furthest apart. The error is not finite if there is none: a share of 0, a line through one value, no period.
void measure_points(const Check& check, Finding& finding);

}  // namespace squall::harness
