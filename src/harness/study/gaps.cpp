#include "harness/study/gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/rain.h"
#include "harness/study/observables.h"
#include "harness/validation/observer.h"

namespace squall::harness {

namespace {

/// The records with series that there are: of points, and of references.
std::vector<const Record*> records_of(const StudyRuns& runs) {
  std::vector<const Record*> records;
  for (const auto& of_point : runs.records)
    if (!of_point.empty() && of_point.front()->error.empty()) records.push_back(of_point.front());
  for (const auto& model : runs.models)
    if (model.reference_record != nullptr) records.push_back(model.reference_record);
  return records;
}

std::string needs_text(const std::string& observable) {
  for (const auto& quantity : quantities())
    if (quantity.name == observable && !quantity.needs.empty()) return fmt::format(" (it needs {})", quantity.needs);
  return "";
}

std::size_t values_in(const Record& record, const std::string& observable) {
  const auto found = record.values.find(observable);
  if (found == record.values.end()) return 0;
  return static_cast<std::size_t>(
      std::count_if(found->second.begin(), found->second.end(), [](double value) { return std::isfinite(value); }));
}

/// How much of an observable the run has that has the least of it; empty if each has all.
std::string partial_text(const std::vector<const Record*>& records, const std::string& observable) {
  const auto lacking = std::min_element(records.begin(), records.end(), [&](const auto* a, const auto* b) {
    return values_in(*a, observable) * b->time_s.size() < values_in(*b, observable) * a->time_s.size();
  });
  const std::size_t have = values_in(**lacking, observable), all = (*lacking)->time_s.size();
  if (have == all) return "";
  return fmt::format(
      "{} has a value at {} of {} output times in the run that has it least{}; errors are over those at "
      "which both runs have it",
      observable, have, all, needs_text(observable));
}

}  // namespace

void require_water(const Scene& scene, int frames) {
  if (frames < 1 || initial_particles(scene).size() > 0) return;
  const auto last = static_cast<std::uint64_t>(frames - 1);
  for (const auto& rain : scene.rains)
    if (drops_due(scene, rain, last) > 0) return;
  std::vector<std::string> names;
  for (const auto& observable : study_observables()) names.push_back(observable.name);
  throw InputError(
      fmt::format("{}: there is no particle in the {:.4g} s that would be studied, so {} have no value and no setting "
                  "an error; the scene needs a [[block]], [[particles]], or [[rain]] that falls by then (--seconds)",
                  scene.name, frames / scene.time.frame_rate_hz, fmt::join(names, ", ")));
}

std::vector<std::string> observable_gaps(const StudyRuns& runs, const StudyQuestion& question) {
  const auto records = records_of(runs);
  std::vector<std::string> gaps, left;
  if (records.empty()) return gaps;
  for (const auto& part : parts_of(question.error)) {
    const bool any =
        std::any_of(records.begin(), records.end(), [&](const Record* record) { return has_value(*record, part); });
    if (!any)
      gaps.push_back(fmt::format("{} has no value at any output time{}", part, needs_text(part)));
    else if (const auto partial = partial_text(records, part); !partial.empty())
      gaps.push_back(partial);
    if (any) left.push_back(part);
  }
  if (!left.empty() && left.size() < parts_of(question.error).size())
    gaps.push_back(fmt::format("the {} error is of {} here", question.error, fmt::join(left, ", ")));
  return gaps;
}

std::string missing_error(const Record& record, const Record* reference, const std::string& error) {
  if (is_exact(error))
    return size_of(record, error) ? "" : fmt::format("no {} error: it has no value at any output time", error);
  if (reference == nullptr) return fmt::format("no {} error: there is no reference to hold it against", error);
  if (difference(record, *reference, error)) return "";
  for (const auto& part : parts_of(error)) {
    const bool here = has_value(record, part), there = has_value(*reference, part);
    if (here && there && !difference(record, *reference, part))
      return fmt::format("no {} error: {} has values at other output times than in the reference", error, part);
    if (here != there)
      return fmt::format("no {} error: {} has no value at any output time {}{}", error, part,
                         here ? "in the reference" : "here", needs_text(part));
  }
  return fmt::format("no {} error: no observable of it has a value", error);
}

}  // namespace squall::harness
