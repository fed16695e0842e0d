#pragma once

#include <string>
#include <vector>

#include "harness/study/study_results.h"
#include "harness/sweep_tables.h"

namespace squall::harness {

/// What every run simulated and how often it was timed, in one line.
std::string study_headline(const StudyResult& result);

/// A line per point: what it costs, how wrong it is, whether it is on the front.
ResultTable cost_table(const StudyResult& result);

/// A line per point: every error, against the yardstick or against its own model's reference.
ResultTable error_table(const StudyResult& result, bool total);

/// A line per model: Lyapunov exponent, horizon, spread of each observable between perturbed starts.
ResultTable noise_table(const StudyResult& result);

/// Orders of convergence.
ResultTable order_table(const StudyResult& result);

/// How each point and each reference is run again: name, command, what differs from the scene.
ResultTable command_table(const StudyResult& result);

/// "0.0123", "<= 0.02" at the noise floor.
std::string error_text(const ErrorFinding& error);

}  // namespace squall::harness
