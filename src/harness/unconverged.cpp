#include "harness/unconverged.h"

#include <fmt/format.h>

namespace squall::harness {

std::string unconverged_text(std::int64_t unconverged, std::int64_t steps) {
  if (unconverged <= 0) return "";
  return fmt::format(
      "{} of {} pressure solves ended at max_iterations above their tolerance, so the water may be denser than asked "
      "for: "
      "raise max_iterations in [solver], or the tolerances",
      unconverged, 2 * steps);
}

}  // namespace squall::harness
