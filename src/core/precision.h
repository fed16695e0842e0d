#pragma once

#include <type_traits>

#include "core/frame_plan.h"

namespace squall {

/// Constants, boxes or sub-steps for a solver that computes in Scalar: in double as they are, in float rounded once.
template <class Scalar, template <class> class Struct>
Struct<Scalar> in_precision(const Struct<double>& value) {
  if constexpr (std::is_same_v<Scalar, double>)
    return value;
  else
    return to_single(value);
}

}  // namespace squall
