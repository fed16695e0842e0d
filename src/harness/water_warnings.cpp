#include "harness/water_warnings.h"

#include <fmt/format.h>

#include <algorithm>

namespace squall::harness {

namespace {

constexpr double k_far_above = 10.0;  ///< tolerances
constexpr double k_visible = 0.01;    ///< of rest density

std::string cut_short(const Row& row) {
  return fmt::format(
      "{} of {} pressure solves ended at max_iterations above their tolerance, so the water may be denser than asked "
      "for: raise max_iterations in [solver], or the tolerances",
      row.unconverged, 2 * row.steps);
}

std::string too_dense(const Row& row) {
  return fmt::format(
      "after its worst frame the water was {:.3g} % too dense on average, where density_tolerance asks for {:.3g} %; "
      "a hard blow, particles that start too close together, walls that squeeze them or too few sub-steps can be why",
      100.0 * row.density_error_worst, 100.0 * row.density_tolerance);
}

}  // namespace

std::vector<std::string> water_warnings(const Row& row) {
  std::vector<std::string> warnings;
  if (row.plan.settings.pressure != Pressure::dfsph) return warnings;
  if (row.unconverged > 0) warnings.push_back(cut_short(row));
  if (row.density_error_worst > std::max(k_visible, k_far_above * row.density_tolerance))
    warnings.push_back(too_dense(row));
  return warnings;
}

}  // namespace squall::harness
