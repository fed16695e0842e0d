#include <algorithm>
#include <cmath>

#include "harness/study/findings.h"
#include "harness/study/observables.h"

namespace squall::harness {

namespace {

/// One of three runs that converge.
struct Rung {
  double h = 0.0;
  const Record* record = nullptr;
  std::size_t model = 0;
};

class OrderFinder {
 public:
  OrderFinder(const StudyRuns& runs, const StudyFindings& findings) : runs_(runs), findings_(findings) {}

  std::vector<OrderFinding> find() {
    for (std::size_t m = 0; m < runs_.points.models.size(); ++m) add("step", m, steps_of(m));
    for (std::size_t m = 0; m < runs_.points.models.size(); ++m)
      if (runs_.points.models[m].is_base) add("spacing", m, spacings_like(m));
    return std::move(orders_);
  }

 private:
  /// Runs of one model that differ in their step alone, coarsest first.
  std::vector<Rung> steps_of(std::size_t model) const {
    std::vector<Rung> rungs;
    for (std::size_t i = 0; i < findings_.points.size(); ++i) {
      const StudyPoint& point = runs_.points.points[i];
      const bool counts = point.model == model && point.tolerance_factor == 1.0 && point.axis != StudyAxis::precision &&
                          point.axis != StudyAxis::backend;
      if (counts && findings_.points[i].status == PointStatus::fine)
        rungs.push_back({findings_.points[i].dt_s, runs_.records[i].front(), model});
    }
    return sorted(std::move(rungs));
  }

  /// References that differ in their spacing alone, coarsest first: no step error that counts is in them.
  std::vector<Rung> spacings_like(std::size_t base) const {
    std::vector<Rung> rungs;
    const auto& like = runs_.points.models[base];
    for (std::size_t m = 0; m < runs_.models.size(); ++m) {
      const auto& model = runs_.points.models[m];
      if (model.pressure == like.pressure && model.scene.fluid.support_ratio == like.scene.fluid.support_ratio &&
          runs_.models[m].reference_record != nullptr)
        rungs.push_back({model.scene.fluid.spacing_m, runs_.models[m].reference_record, m});
    }
    return sorted(std::move(rungs));
  }

  static std::vector<Rung> sorted(std::vector<Rung> rungs) {
    std::sort(rungs.begin(), rungs.end(), [](const Rung& a, const Rung& b) { return a.h > b.h; });
    return rungs;
  }

  void add(const char* of, std::size_t model, const std::vector<Rung>& rungs) {
    for (std::size_t i = 0; i + 2 < rungs.size(); ++i)
      for (const auto& error : error_names()) add_order(of, model, {rungs[i], rungs[i + 1], rungs[i + 2]}, error);
  }

  /// Below the horizon runs follow each other, and what is left of them is the error of the step. The error that they
  /// bring along parts them sooner than a perturbed start would: there, too, 0.1 dx is where it ends.
  double until_of(const std::vector<Rung>& rungs) const {
    double until_s = k_no_end;
    for (const Rung& rung : rungs)
      if (const auto& growth = findings_.models[rung.model].growth; growth && growth->horizon_s)
        until_s = std::min(until_s, *growth->horizon_s);
    for (std::size_t i = 0; i + 1 < rungs.size(); ++i)
      if (rungs[i].model == rungs[i + 1].model)
        until_s = std::min(until_s, last_together_s(*rungs[i].record, *rungs[i + 1].record));
    return std::min(until_s, rungs.front().record->time_s.empty() ? 0.0 : rungs.front().record->time_s.back());
  }

  /// The last output time before the median particle is 0.1 dx from its place in the other run; without tracks, no end.
  static double last_together_s(const Record& a, const Record& b) {
    double together_s = 0.0;
    for (std::size_t i = 0; i < a.time_s.size(); ++i) {
      const auto apart = separation(a, b, i);
      if (!apart) return i == 0 ? k_no_end : together_s;
      if (*apart >= k_horizon_dx) return together_s;
      together_s = a.time_s[i];
    }
    return k_no_end;
  }

  std::optional<double> floor_between(const Rung& a, const Rung& b, const std::string& error, double until_s) const {
    const auto of_a = noise_of(runs_.models[a.model].noise_records, until_s);
    const auto of_b = a.model == b.model ? of_a : noise_of(runs_.models[b.model].noise_records, until_s);
    if (!of_a || !of_b || !of_a->spread.contains(error) || !of_b->spread.contains(error)) return std::nullopt;
    return noise_floor(of_a->spread.at(error), of_b->spread.at(error));
  }

  void add_order(const char* of, std::size_t model, const std::vector<Rung>& rungs, const std::string& error) {
    OrderFinding finding;
    finding.model = runs_.points.models[model].name;
    finding.of = of;
    finding.error = error;
    finding.until_s = until_of(rungs);
    for (const Rung& rung : rungs) finding.h.push_back(rung.h);
    for (std::size_t i = 0; i + 1 < rungs.size(); ++i) {
      const auto apart = difference(*rungs[i].record, *rungs[i + 1].record, error, finding.until_s);
      if (!apart) return;
      finding.apart.push_back(*apart);
      const auto floor = floor_between(rungs[i], rungs[i + 1], error, finding.until_s);
      if (floor && *apart <= *floor) finding.problem = "at the noise floor";
    }
    if (finding.problem.empty())
      finding.order = order_of(finding.h[0], finding.h[1], finding.h[2], finding.apart[0], finding.apart[1]);
    if (!finding.order && finding.problem.empty()) finding.problem = "it does not converge";
    orders_.push_back(std::move(finding));
  }

  const StudyRuns& runs_;
  const StudyFindings& findings_;
  std::vector<OrderFinding> orders_;
};

}  // namespace

std::vector<OrderFinding> find_orders(const StudyRuns& runs, const StudyFindings& findings) {
  return OrderFinder(runs, findings).find();
}

}  // namespace squall::harness
