#include "harness/study/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "harness/report/plain_text.h"
#include "harness/statistics.h"
#include "harness/study/gaps.h"
#include "harness/study/observables.h"
#include "harness/study/pareto.h"

namespace squall::harness {

namespace {

constexpr double k_largest_compression = 0.25;  ///< mean, in any frame: no water any more
constexpr double k_largest_gain = 0.25;         ///< of the energy's scale (observable_scales), out of nothing

/// Why the end state, or the way there, is no water; empty if it is.
std::string instability_of(const StudyPoint& point, const Record& record) {
  if (!record.error.empty()) return record.error;
  const auto found = record.values.find("density_error_mean");
  if (found != record.values.end())
    for (const double value : found->second)  // NaN while there is no water yet
      if (value > k_largest_compression)
        return fmt::format("mean compression of {:.3g} %; {:g} % is the most that is taken for water", 100.0 * value,
                           100.0 * k_largest_compression);
  if (point.run.scene.container.motions.empty() && !(record.energy_gain <= k_largest_gain))
    return fmt::format(
        "it gains energy out of nothing: {:.3g} % of what it had above the floor, M g D/2; {:g} % is the "
        "most that is taken for water",
        100.0 * record.energy_gain, 100.0 * k_largest_gain);
  return "";
}

template <class Value>
double median_over(const std::vector<const Record*>& records, Value value) {
  std::vector<double> values;
  for (const Record* record : records) values.push_back(value(*record));
  return median(std::move(values));
}

class Judge {
 public:
  Judge(const StudyRuns& runs, const StudyQuestion& question) : runs_(runs), question_(question) {
    const auto names = error_names();
    if (std::find(names.begin(), names.end(), question.error) == names.end())
      throw InputError(fmt::format("the error '{}' is unknown; there are {}", question.error, fmt::join(names, ", ")));
  }

  StudyFindings judge() {
    judge_models();
    choose_yardstick();
    for (std::size_t i = 0; i < runs_.points.points.size(); ++i) judge_point(i);
    rank();
    result_.orders = find_orders(runs_, result_);
    result_.gaps = observable_gaps(runs_, question_);
    return std::move(result_);
  }

 private:
  void judge_models() {
    for (const auto& model : runs_.models)
      result_.models.push_back({noise_of(model.noise_records), growth_of(model.noise_records)});
  }

  /// The reference of the finest spacing; there, of water that keeps its volume, at the scene's own support ratio.
  void choose_yardstick() {
    const auto worth = [&](std::size_t m) {
      const StudyModel& model = runs_.points.models[m];
      const int solver = model.pressure == Pressure::dfsph ? 2 : model.pressure == Pressure::wcsph ? 1 : 0;
      return std::tuple(-model.scene.fluid.spacing_m, solver, model.is_base ? 1 : 0);
    };
    for (std::size_t m = 0; m < runs_.models.size(); ++m)
      if (runs_.models[m].reference_record != nullptr && (!result_.yardstick || worth(m) > worth(*result_.yardstick)))
        result_.yardstick = m;
  }

  void judge_point(std::size_t i) {
    result_.points.emplace_back();
    const auto& records = runs_.records[i];
    if (records.empty()) return;
    PointFinding& finding = result_.points.back();
    const Record& first = *records.front();
    for (const Record* record : records) finding.wall_s_per_s.push_back(record->wall_s_per_s());
    finding.cost = median(finding.wall_s_per_s);
    finding.frame_ms_median = median_over(records, [](const Record& r) { return r.frame_ms_median; });
    finding.frame_ms_p95 = median_over(records, [](const Record& r) { return r.frame_ms_p95; });
    finding.dt_s = first.mean_dt_s();
    finding.reason = instability_of(runs_.points.points[i], first);
    finding.status = first.device_failed      ? PointStatus::failed
                     : finding.reason.empty() ? PointStatus::fine
                                              : PointStatus::unstable;
    if (finding.status != PointStatus::fine) return;
    judge_errors(i, first, finding);
    const Record* yardstick = result_.yardstick ? runs_.models[*result_.yardstick].reference_record : nullptr;
    finding.reason = missing_error(first, yardstick, question_.error);
  }

  void judge_errors(std::size_t i, const Record& record, PointFinding& finding) const {
    const std::size_t own = runs_.points.points[i].model;
    for (const auto& error : error_names()) {
      add_error(record, error, own, own, finding.step_errors);
      if (is_exact(error))
        add_exact_error(record, error, own, finding.total_errors);
      else if (result_.yardstick)
        add_error(record, error, own, *result_.yardstick, finding.total_errors);
    }
    const auto& growth = result_.models[own].growth;
    const Record* reference = runs_.models[own].reference_record;
    if (reference == nullptr || !growth || !growth->horizon_s) return;
    const auto at = std::find(record.time_s.begin(), record.time_s.end(), *growth->horizon_s);
    if (at != record.time_s.end())
      finding.trajectory_dx = separation(record, *reference, static_cast<std::size_t>(at - record.time_s.begin()));
  }

  std::optional<double> spread_of(std::size_t model, const std::string& error) const {
    const auto& noise = result_.models[model].noise;
    if (!noise) return std::nullopt;
    const auto found = noise->spread.find(error);
    return found == noise->spread.end() ? std::nullopt : std::optional(found->second);
  }

  void add_error(const Record& record, const std::string& error, std::size_t own, std::size_t against,
                 std::map<std::string, ErrorFinding>& errors) const {
    const Record* reference = runs_.models[against].reference_record;
    const auto apart = reference == nullptr ? std::nullopt : difference(record, *reference, error);
    if (!apart) return;
    const auto a = spread_of(own, error), b = spread_of(against, error);
    errors[error] = {*apart, a && b ? std::optional(noise_floor(*a, *b)) : std::nullopt};
  }

  void add_exact_error(const Record& record, const std::string& error, std::size_t own,
                       std::map<std::string, ErrorFinding>& errors) const {
    const auto size = size_of(record, error);
    const auto spread = spread_of(own, error);
    if (size) errors[error] = {*size, spread ? std::optional(noise_floor(*spread, *spread)) : std::nullopt};
  }

  void rank() {
    std::vector<std::size_t> of;
    std::vector<Choice> choices;
    for (std::size_t i = 0; i < result_.points.size(); ++i) {
      const PointFinding& point = result_.points[i];
      const auto error = point.total_errors.find(question_.error);
      if (error == point.total_errors.end()) continue;
      of.push_back(i);
      choices.push_back({point.cost, error->second.ranked(), point.frame_ms_p95});
    }
    const auto front = pareto_front(choices);
    for (std::size_t c = 0; c < choices.size(); ++c) {
      if (!front[c]) continue;
      result_.points[of[c]].on_front = true;
      result_.front.push_back(of[c]);
    }
    std::stable_sort(result_.front.begin(), result_.front.end(),
                     [&](auto a, auto b) { return result_.points[a].cost < result_.points[b].cost; });
    if (question_.max_error)
      if (const auto c = cheapest_within(choices, *question_.max_error)) result_.cheapest = of[*c];
    if (question_.budget_ms)
      if (const auto c = best_within(choices, *question_.budget_ms)) result_.best = of[*c];
  }

  const StudyRuns& runs_;
  const StudyQuestion& question_;
  StudyFindings result_;
};

}  // namespace

const char* to_string(PointStatus status) {
  switch (status) {
    case PointStatus::fine:
      return "fine";
    case PointStatus::unstable:
      return "unstable";
    case PointStatus::failed:
      return "failed";
    case PointStatus::not_run:
      break;
  }
  return "not_run";
}

StudyFindings find_out(const StudyRuns& runs, const StudyQuestion& question) { return Judge(runs, question).judge(); }

}  // namespace squall::harness
