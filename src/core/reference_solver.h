#pragma once

#include <memory>

#include "core/solver.h"

namespace squall::reference {

/// The specification: every pass as plain as it can be, on one thread, in double (or, to compare bits, in float).
/// The solver holds no particles yet.
std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings);

}  // namespace squall::reference
