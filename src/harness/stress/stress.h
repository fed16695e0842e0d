#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/settings.h"
#include "core/solver.h"

namespace squall::harness {

/// Makes a solver with the particles that its scene starts from.
using StressFactory =
    std::function<std::unique_ptr<Solver>(const std::string& backend, const Scene& scene, const Settings& settings)>;

/// Who is tried.
struct StressSubject {
  std::string label;  ///< "omp, 2 threads, wcsph"
  std::string backend;
  Settings settings;
};

/// One number that a case measured and what it has to be.
struct StressFinding {
  enum class Relation { at_most, at_least, equal, information };
  std::string what;  ///< with its unit: "fastest particle [m/s]"
  double value = 0.0;
  Relation relation = Relation::information;
  double limit = 0.0;
  /// NaN never holds; information always does.
  bool holds() const;
};

/// What a case found out about a subject.
struct StressOutcome {
  std::vector<StressFinding> findings;
  std::string not_applicable;  ///< why there is nothing to try; empty if it was tried
  std::string error;           ///< of what() where the solver gave up although it must not

  void at_most(std::string what, double value, double limit);
  void at_least(std::string what, double value, double limit);
  void equal(std::string what, double value, double limit);
  void information(std::string what, double value);
  bool holds() const;
};

class StressBench;

/// A hard case: a scene or a state that breaks solvers, and what a good one does (docs/stress.md).
struct StressCase {
  int number = 0;  ///< 1..34, as in docs/stress.md
  const char* name = "";
  const char* required = "";  ///< one sentence
  bool quick = true;          ///< part of --quick
  void (*run)(const StressBench& bench, StressOutcome& outcome) = nullptr;
};

/// All cases by number.
std::span<const StressCase> stress_cases();

/// A finding that is known to fail in a pressure solver, and why (docs/stress.md).
struct KnownStressFailure {
  int number = 0;
  Pressure pressure = Pressure::wcsph;
  const char* finding = "";  ///< how its text begins; empty: any of the case
  const char* why = "";
};
std::span<const KnownStressFailure> known_failures();

enum class StressVerdict {
  passed,
  failed_as_expected,  ///< and docs/stress.md says why
  not_applicable,
  failed,               ///< unexpected
  passed_unexpectedly,  ///< what is known to fail held: the table is out of date
};
const char* to_string(StressVerdict verdict);

/// A line of the result.
struct StressResult {
  const StressCase* tried = nullptr;
  StressSubject subject;
  StressOutcome outcome;
  std::string why;  ///< of the known failures that were met
  StressVerdict verdict = StressVerdict::not_applicable;
  double wall_s = 0.0;
  bool unexpected() const { return verdict == StressVerdict::failed || verdict == StressVerdict::passed_unexpectedly; }
};

/// Tries one case. An error of the machine's (DeviceError) goes on to the caller; any other that the solver throws is
/// the case's failure.
StressResult try_case(const StressCase& tried, const StressSubject& subject, const StressFactory& make, bool quick);

}  // namespace squall::harness
