#include "harness/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "core/errors.h"
#include "core/frame_plan.h"

namespace squall::harness {

namespace {

using Clock = std::chrono::steady_clock;

/// What a run should cost, in sub-steps of a particle on omp: only ratios matter.
double expected_work(const StudyRun& run) {
  constexpr double k_double = 2.0, k_reference = 15.0, k_incompressible = 2.5;
  const Settings& settings = run.plan.settings;
  const double limit = time_step_limit(run.scene, settings.pressure, run.scene.reached_speed());
  const double substeps = std::ceil(1.0 / (run.scene.time.frame_rate_hz * limit));
  double work = static_cast<double>(particle_capacity(run.scene)) * substeps;
  work *= run.plan.frames + run.plan.warm_up_frames;
  if (settings.pressure == Pressure::dfsph) work *= k_incompressible;
  if (run.plan.backend == "reference") return work * k_reference;
  return settings.precision == Precision::double_precision ? k_double * work : work;
}

class Student {
 public:
  Student(const StudySubjects& subjects, const Context& context, const StudySolverFactory& make, StudyRecords& records,
          const AfterStudyFrame& after_frame)
      : subjects_(subjects), context_(context), make_(make), records_(records), after_frame_(after_frame) {
    if (subjects_.pressures.empty() || subjects_.plans.empty())
      throw InputError("a study needs a pressure solver and a backend to begin with");
    result_.points = make_points(subjects_);
    if (result_.points.points.empty())
      throw InputError(result_.points.notes.empty() ? "the study has no points; vary something it can"
                                                    : result_.points.notes.front());
    result_.records.resize(result_.points.points.size());
    result_.models.resize(result_.points.models.size());
    for (std::size_t m = 0; m < result_.models.size(); ++m)
      result_.models[m].noise = noise_runs(subjects_, result_.points, m);
    plan_work();
  }

  StudyRuns run() {
    time_points(0);
    for (std::size_t m = 0; m < result_.models.size(); ++m) run_noise(result_.models[m]);
    for (std::size_t m = 0; m < result_.models.size(); ++m) run_reference(m);
    for (int repeat = 1; repeat < subjects_.ranges.repeats; ++repeat) time_points(repeat);
    return std::move(result_);
  }

 private:
  /// What lies ahead, references as far as they can be foreseen.
  void plan_work() {
    for (const auto& point : result_.points.points) {
      const double work = expected_work(point.run);
      work_left_ += work * subjects_.ranges.repeats;
    }
    for (std::size_t m = 0; m < result_.models.size(); ++m) {
      for (const auto& run : result_.models[m].noise) work_left_ += expected_work(run);
      work_left_ += reference_work(m);
    }
    work_total_ = std::max(work_left_, 1.0);
  }

  double reference_work(std::size_t m) const {
    constexpr double k_finer = 8.0;
    double finest = 0.0;
    for (const auto& point : result_.points.points) {
      if (point.model != m) continue;
      StudyRun like = point.run;
      like.plan = subjects_.double_plan;
      like.plan.settings.pressure = result_.points.models[m].pressure;
      finest = std::max(finest, k_finer * expected_work(like));
    }
    return finest;
  }

  void time_points(int repeat) {
    for (std::size_t i = 0; i < result_.points.points.size() && !result_.interrupted; ++i) {
      StudyRun run = result_.points.points[i].run;
      run.repeat = repeat;
      // What cannot be computed takes no less time to fail again.
      if (repeat > 0 && (result_.records[i].empty() || !result_.records[i].front()->error.empty())) {
        forget(expected_work(run));
        continue;
      }
      if (const Record* record = carry_out(run, result_.points.points[i].name, expected_work(run)))
        result_.records[i].push_back(record);
    }
  }

  void run_noise(ModelRuns& model) {
    for (const auto& run : model.noise) {
      if (result_.interrupted) return;
      const Record* record = carry_out(run, run.plan.label, expected_work(run));
      if (record != nullptr && record->error.empty()) model.noise_records.push_back(record);
    }
  }

  void run_reference(std::size_t m) {
    ModelRuns& model = result_.models[m];
    double finest_dt_s = k_no_end;
    int most_substeps = 0;
    for (std::size_t i = 0; i < result_.points.points.size(); ++i) {
      const bool counts = result_.points.points[i].model == m && !result_.records[i].empty();
      if (!counts || !result_.records[i].front()->error.empty()) continue;
      finest_dt_s = std::min(finest_dt_s, result_.records[i].front()->smallest_dt_s);
      most_substeps = std::max(most_substeps, result_.records[i].front()->most_substeps);
    }
    const double work = reference_work(m);
    if (result_.interrupted) return;
    if (most_substeps == 0) {
      model.problem = "no point of this model ran to its end, so there is no step to be an eighth of";
      return forget(work);
    }
    try {
      model.reference = reference_run(subjects_, result_.points, m, finest_dt_s, most_substeps);
    } catch (const InputError& refusal) {
      model.problem = refusal.what();
      return forget(work);
    }
    const Record* record = carry_out(*model.reference, model.reference->plan.label, work);
    if (record != nullptr && record->error.empty()) model.reference_record = record;
    if (record != nullptr) model.problem = record->error;
  }

  void forget(double work) {
    work_left_ -= work;
    work_total_ -= work;
  }

  /// The record of a run: kept, or made now. Null if it was ended early.
  const Record* carry_out(const StudyRun& run, const std::string& name, double work) {
    const std::string key = key_of(run, context_);
    if (const Record* known = records_.find(key)) {
      if (counted_.insert(key).second) ++result_.reused;
      forget(work);
      return known;
    }
    const auto start = Clock::now();
    auto record = record_run(run, key, make_, [&](double share) { return go_on(name, work, share, start); });
    if (!record) {
      result_.interrupted = true;
      return nullptr;
    }
    spent_s_ += seconds_since(start);
    work_done_ += work;
    work_left_ -= work;
    records_.add(std::move(*record));
    counted_.insert(key);
    return records_.find(key);
  }

  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  bool go_on(const std::string& name, double work, double share, Clock::time_point start) {
    if (!after_frame_) return true;
    const double done = work_done_ + share * work, left = std::max(0.0, work_left_ - share * work);
    const double seconds = spent_s_ + seconds_since(start);
    const double left_s = done > 0.0 ? seconds * left / done : 0.0;
    const bool on = after_frame_({name, std::clamp(1.0 - left / work_total_, 0.0, 1.0), left_s});
    if (!on) result_.interrupted = true;
    return on;
  }

  const StudySubjects& subjects_;
  const Context& context_;
  const StudySolverFactory& make_;
  StudyRecords& records_;
  const AfterStudyFrame& after_frame_;
  StudyRuns result_;
  std::set<std::string> counted_;  ///< keys of runs that were reused or made: one may serve twice
  double work_total_ = 0.0, work_left_ = 0.0, work_done_ = 0.0, spent_s_ = 0.0;
};

}  // namespace

void StudyRecords::put(Record record) {
  const std::string key = record.key;
  records_.insert_or_assign(key, std::move(record));
}

void StudyRecords::add(Record record) {
  if (keep_ && !record.device_failed) keep_(record);  // a device may be back next time
  put(std::move(record));
}

const Record* StudyRecords::find(const std::string& key) const {
  const auto found = records_.find(key);
  return found == records_.end() ? nullptr : &found->second;
}

StudyRuns run_study(const StudySubjects& subjects, const Context& context, const StudySolverFactory& make,
                    StudyRecords& records, const AfterStudyFrame& after_frame) {
  return Student(subjects, context, make, records, after_frame).run();
}

}  // namespace squall::harness
