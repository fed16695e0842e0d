#include "harness/agree/judge.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/agreement.h"

namespace squall::harness {

namespace {

/// Without the guarantee, OpenCL 1.2 (table 7.4) allows 3 ulp for a square root and 2.5 for a division where half a one
/// is right: six times the error.
constexpr double k_unpromised_errors = 6.0;

bool equal(const Ulps& a, const Ulps& b) { return a.max == b.max && a.rms == b.rms; }

bool within(const Ulps& found, const Ulps& right) {
  return found.max <= k_unpromised_errors * std::max(right.max, 1.0);
}

bool within(const StepErrors& found, const StepErrors& right) {
  return within(found.density, right.density) && within(found.pressure, right.pressure) &&
         within(found.force, right.force);
}

Verdict worse(Verdict a, Verdict b) {
  if (a == Verdict::differs || b == Verdict::differs) return Verdict::differs;
  return a == Verdict::within || b == Verdict::within ? Verdict::within : Verdict::same;
}

Verdict verdict_on(const IntegerCheck& check, bool strict) {
  if (check.exact()) return Verdict::same;
  // A distance rounded otherwise may cross H; cells, and with them the order, need no more than a multiplication.
  return !strict && check.same_order ? Verdict::within : Verdict::differs;
}

std::string integer_note(const StepCheck& step) {
  const IntegerCheck& check = step.integers;
  std::string text = fmt::format("one step {}:", step.start);
  if (!check.same_order) text += " another order;";
  if (check.neighbours_differ > 0)
    text += fmt::format(" {} particles with another number of neighbours;", check.neighbours_differ);
  if (!check.same_counts) text += " other counts of active, clamped or lost particles;";
  if (check.first_particle) text += fmt::format(" first particle {}", *check.first_particle);
  return text;
}

std::string error_note(const StepCheck& step, const StepErrors& right) {
  const StepErrors& errors = step.errors;
  return fmt::format(
      "one step {}: off double precision by {:.3g}, {:.3g} and {:.3g} ulp in density, pressure and force, where the "
      "reference in single precision is off by {:.3g}, {:.3g} and {:.3g}",
      step.start, errors.density.max, errors.pressure.max, errors.force.max, right.density.max, right.pressure.max,
      right.force.max);
}

}  // namespace

void judge_steps(const Oracle& oracle, const std::vector<OneStep>& steps, SubjectResult& result) {
  const bool strict = result.subject.plan.strict;
  if (!steps.empty()) result.integers = result.one_step = Verdict::same;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const StepCheck step{oracle.starts[i].name, check_integers(oracle.steps[i], steps[i]),
                         step_errors(oracle.double_steps[i], steps[i])};
    const StepErrors& right = oracle.step_errors[i];
    const Verdict integers = verdict_on(step.integers, strict);
    if (integers != Verdict::same) result.notes.push_back(integer_note(step));
    Verdict errors = Verdict::same;
    if (!equal(step.errors.density, right.density) || !equal(step.errors.force, right.force))
      errors = !strict && within(step.errors, right) ? Verdict::within : Verdict::differs;
    if (errors == Verdict::differs) result.notes.push_back(error_note(step, right));
    result.integers = worse(result.integers, integers);
    result.one_step = worse(result.one_step, errors);
    result.steps.push_back(step);
  }
  if (steps.empty()) result.notes.push_back("no single steps: the scene has no particles yet");
}

void judge_run(const Oracle& oracle, const Trajectory& run, const Scene& scene, SubjectResult& result) {
  result.hashes = run.hashes;
  result.substeps = run.substeps;
  result.error = run.error;
  if (run.hashes == oracle.run.hashes && run.error == oracle.run.error) {
    result.bits = result.long_run = Verdict::same;
    return;
  }
  result.bits = Verdict::differs;
  result.growth = growth_between(oracle.run, run, scene.fluid.spacing_m);
  if (result.subject.plan.strict || result.growth.empty()) return;
  const double allowed = rounding_tolerance_dx(
      scene, static_cast<int>(oracle.run.substeps / std::max<std::int64_t>(1, std::ssize(oracle.run.hashes))) + 1,
      Precision::single_precision);
  if (result.growth.front().max_dx <= allowed)
    result.bits = Verdict::within;
  else
    result.notes.push_back(fmt::format("{:.3g} dx away after the first frame, {:.3g} dx explained by rounding",
                                       result.growth.front().max_dx, allowed));
}

void judge_observables(const std::vector<ObservedDistance>& observed, SubjectResult& result) {
  result.observed = observed;
  result.long_run = Verdict::within;
  for (const auto& one : observed) {
    if (one.within()) continue;
    result.long_run = Verdict::differs;
    result.notes.push_back(fmt::format("{} is {:.3g} off over the long run; runs that are rounded otherwise, {:.3g}",
                                       one.what, one.distance, one.floor));
  }
}

bool SubjectResult::agrees() const {
  for (const Verdict verdict : {integers, one_step, again, restart, hand_over})
    if (verdict == Verdict::differs) return false;
  // Where bits are promised, water that looks alike is not enough.
  return bits != Verdict::differs && long_run != Verdict::differs;
}

bool AgreeResult::agree() const {
  return std::all_of(subjects.begin(), subjects.end(),
                     [](const SubjectResult& subject) { return subject.device_failed || subject.agrees(); });
}

bool AgreeResult::device_failed() const {
  return std::any_of(subjects.begin(), subjects.end(), [](const auto& subject) { return subject.device_failed; });
}

}  // namespace squall::harness
