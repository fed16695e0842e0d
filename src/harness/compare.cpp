#include "harness/compare.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "core/errors.h"

namespace squall::harness {

namespace {

/// Idle threads of libgomp and of CPU OpenCL drivers spin for a few milliseconds before they sleep; a run that starts
/// meanwhile shares its cores with them.
constexpr std::chrono::milliseconds k_settle_time{10};

bool share_threads(const RunPlan& a, const RunPlan& b) {
  return a.backend == b.backend && a.settings.device == b.settings.device && a.settings.threads == b.settings.threads &&
         a.settings.simd == b.settings.simd && a.settings.precision == b.settings.precision;
}

std::vector<std::vector<std::size_t>> group_runs(const std::vector<RunPlan>& plans) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& members) {
      return share_threads(plans[members.front()], plans[i]);
    });
    if (group == groups.end())
      groups.push_back({i});
    else
      group->push_back(i);
  }
  return groups;
}

void check_plans(const std::vector<RunPlan>& plans) {
  if (plans.empty()) throw InputError("nothing to compare: no backend or device is left; widen --backend or --device");
  for (const auto& plan : plans)
    if (plan.frames != plans.front().frames || plan.warm_up_frames != plans.front().warm_up_frames || plan.rewind)
      throw InputError("compared runs need the same frames and warm-up frames, and no rewinding");
}

/// The runs of a comparison; those whose device failed at the start have none.
class Comparer {
 public:
  Comparer(const SolverFactory& make, const std::vector<RunPlan>& plans) : make_(make), plans_(plans) {
    for (const auto& plan : plans_) {
      failures_.emplace_back();
      try {
        runs_.push_back(std::make_unique<Run>(make_(plan), plan));
      } catch (const DeviceError& failure) {
        runs_.push_back(nullptr);
        failures_.back() = failure.what();
      }
    }
  }

  void round(int number) {
    const RunPlan* previous = nullptr;
    for (const std::size_t i : order_of_round(plans_, number)) {
      if (!runs_[i] || runs_[i]->done()) continue;
      if (previous == nullptr || !share_threads(*previous, plans_[i])) std::this_thread::sleep_for(k_settle_time);
      previous = &plans_[i];
      runs_[i]->step();
    }
    check_.after_round(living());
  }

  Comparison result() const {
    Comparison result;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      result.rows.push_back(row_of(i));
      result.frames.push_back(runs_[i] ? runs_[i]->frames() : std::vector<FrameRecord>{});
    }
    result.agreement = check_.result();
    add_exposed_readback(result);
    add_profiles(result.rows);
    add_reference_errors(result.rows);
    return result;
  }

 private:
  std::vector<const Run*> living() const {
    std::vector<const Run*> runs;
    for (const auto& run : runs_)
      if (run) runs.push_back(run.get());
    return runs;
  }

  Row row_of(std::size_t i) const {
    if (runs_[i]) return runs_[i]->row();
    Row row;
    row.plan = plans_[i];
    row.solver.backend = plans_[i].backend;
    row.error = failures_[i];
    row.device_failed = true;
    return row;
  }

  /// What delivering positions adds to a frame: differences frame by frame against the same run without read-back, so
  /// that what both share cancels.
  void add_exposed_readback(Comparison& comparison) const {
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      for (std::size_t base = 0; base < plans_.size(); ++base) {
        if (i == base || !share_threads(plans_[i], plans_[base])) continue;
        if (plans_[base].settings.readback != Readback::none || !comparison.rows[i].error.empty()) continue;
        const auto &with = comparison.frames[i], &without = comparison.frames[base];
        std::vector<double> differences;
        for (std::size_t f = 0; f < std::min(with.size(), without.size()); ++f)
          differences.push_back(with[f].report.frame_ms - without[f].report.frame_ms);
        if (differences.empty()) continue;
        comparison.rows[i].exposed_readback_ms = median(differences);
        comparison.rows[i].exposed_readback_interval_ms = median_interval(differences);
      }
    }
  }

  void add_profiles(std::vector<Row>& rows) const {
    for (std::size_t i = 0; i < plans_.size(); ++i)
      if (runs_[i] && rows[i].error.empty()) add_profile(profile_run(make_, plans_[i], runs_[i]->state()), rows[i]);
  }

  void add_reference_errors(std::vector<Row>& rows) const {
    const auto reference =
        std::find_if(plans_.begin(), plans_.end(), [](const RunPlan& plan) { return plan.backend == "reference"; });
    if (reference == plans_.end()) return;
    const auto r = static_cast<std::size_t>(reference - plans_.begin());
    if (!runs_[r] || !rows[r].error.empty()) return;
    double largest = 0.0;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (i == r || !runs_[i] || !rows[i].error.empty()) continue;
      const auto difference = difference_between(runs_[r]->state().particles, runs_[i]->state().particles,
                                                 runs_[r]->scene().fluid.spacing_m);
      rows[i].position_error_dx = difference ? difference->max_position_error_dx : 0.0;
      largest = std::max(largest, *rows[i].position_error_dx);
    }
    if (plans_.size() > 1) rows[r].position_error_dx = largest;
  }

  const SolverFactory& make_;
  const std::vector<RunPlan>& plans_;
  std::vector<std::unique_ptr<Run>> runs_;
  std::vector<std::string> failures_;
  AgreementCheck check_;
};

}  // namespace

std::vector<std::size_t> order_of_round(const std::vector<RunPlan>& plans, int round) {
  const auto groups = group_runs(plans);
  const auto turn = static_cast<std::size_t>(round);
  std::vector<std::size_t> order;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto& members = groups[(g + turn) % groups.size()];
    for (std::size_t m = 0; m < members.size(); ++m) order.push_back(members[(m + turn) % members.size()]);
  }
  return order;
}

Comparison compare(const SolverFactory& make, const std::vector<RunPlan>& plans, const AfterRound& after_round) {
  check_plans(plans);
  Comparer comparer(make, plans);
  const int rounds = plans.front().warm_up_frames + plans.front().frames;
  for (int round = 0; round < rounds; ++round) {
    comparer.round(round);
    if (after_round && !after_round(round + 1, rounds)) break;
  }
  return comparer.result();
}

}  // namespace squall::harness
