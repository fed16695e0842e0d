#include "harness/agree/agree.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <new>
#include <utility>

#include "core/checkpoint.h"
#include "core/errors.h"
#include "harness/agree/judge.h"
#include "harness/agreement.h"

namespace squall::harness {

namespace {

constexpr int k_longest_tail = 10;  ///< frames after a restart or hand-over

void check(const std::vector<Subject>& subjects, const AgreeSettings& settings) {
  if (subjects.empty() || subjects.front().plan.backend != "reference" ||
      subjects.front().plan.settings.precision != Precision::single_precision)
    throw InputError("agreement is judged by the reference in single precision, which must be the first subject");
  if (settings.frames < 1 || settings.horizon < 1 || settings.members < 1)
    throw InputError(
        fmt::format("agreement over {} frames, {} of them one by one, with {} perturbed runs; each must "
                    "be at least 1",
                    settings.frames, settings.horizon, settings.members));
}

class Agreeing {
 public:
  Agreeing(const SolverFactory& make, const std::vector<Subject>& subjects, const AgreeSettings& settings,
           const AgreeProgress& progress)
      : make_(make), subjects_(subjects), progress_(progress), middle_(settings.frames / 2) {
    result_.settings = settings;
    const int tail = std::min(k_longest_tail, settings.frames - middle_);
    const auto per_subject = 2 * settings.frames + 2 * tail;
    frames_to_do_ = static_cast<int>(subjects.size()) * per_subject + (1 + settings.members) * settings.frames;
    tail_ = tail;
  }

  AgreeResult run() {
    follow_oracle();
    for (const Subject& subject : subjects_) {
      if (stopped_) break;
      try_subject(subject);
    }
    if (!stopped_) hand_over_to_first();
    if (!stopped_) observe_long_runs();
    if (!stopped_) compare_pairs();
    result_.interrupted = stopped_;
    return std::move(result_);
  }

 private:
  std::unique_ptr<Solver> make(const Subject& subject) const { return make_(subject.plan); }
  const Scene& scene() const { return *scene_; }
  EveryFrame every_frame(const std::string& doing) {
    return [this, doing] {
      const double share = static_cast<double>(++frames_done_) / frames_to_do_;
      stopped_ = stopped_ || (progress_ && !progress_(std::min(share, 1.0), doing));
      return !stopped_;
    };
  }
  Trajectory follow_all(Solver& solver, const std::string& doing) {
    return follow(solver, result_.settings.frames, {result_.settings.horizon, middle_}, every_frame(doing));
  }

  void follow_oracle();
  void add_starts(Solver& single, Solver& in_double);
  void try_subject(const Subject& subject);
  void measure(const Subject& subject, SubjectResult& result);
  Verdict restart_of(const Subject& subject, const Trajectory& run);
  Verdict hand_over(Solver& solver, bool strict, std::vector<std::string>& notes);
  void hand_over_to_first();
  State through_checkpoint(const State& state) const;
  Trajectory perturbed_run(Solver& solver, int member);
  void observe_long_runs();
  void compare_pairs();
  std::optional<FirstDifference> locate(const Subject& a, const Subject& b, std::uint64_t frames_before);

  const SolverFactory& make_;
  const std::vector<Subject>& subjects_;
  const AgreeProgress& progress_;
  AgreeResult result_;
  std::unique_ptr<Solver> reference_;  ///< in single precision
  const Scene* scene_ = nullptr;
  Oracle oracle_;
  std::map<std::size_t, Trajectory> other_runs_;  ///< of subjects with other bits than the reference
  const Subject* giver_ = nullptr;                ///< whose middle the next subject goes on from
  Trajectory given_;
  int middle_ = 0, tail_ = 0;
  int frames_to_do_ = 1, frames_done_ = 0;
  bool stopped_ = false;
};

void Agreeing::follow_oracle() {
  reference_ = make(subjects_.front());
  scene_ = &reference_->scene();
  RunPlan plan = subjects_.front().plan;
  plan.settings.precision = Precision::double_precision;
  const auto in_double = make_(plan);
  oracle_.start = reference_->state();
  in_double->restore(oracle_.start);
  oracle_.double_run = follow_all(*in_double, "double precision");
  if (stopped_) return;
  oracle_.run = follow_all(*reference_, subjects_.front().plan.label);
  if (stopped_) return;
  result_.double_growth = growth_between(oracle_.double_run, oracle_.run, scene().fluid.spacing_m);
  add_starts(*reference_, *in_double);
}

void Agreeing::add_starts(Solver& single, Solver& in_double) {
  const auto add = [&](const char* name, const State& state) {
    if (state.particles.size() > 0) oracle_.starts.push_back({name, state});
  };
  add("from the start", oracle_.start);
  if (oracle_.run.middle.clock.frame > oracle_.start.clock.frame) {
    add("from half-way", oracle_.run.middle);
    add("from half-way at rest", stilled(oracle_.run.middle));
  }
  for (const StartState& start : oracle_.starts) {
    oracle_.steps.push_back(take_one_step(single, start.state));
    oracle_.double_steps.push_back(take_one_step(in_double, start.state));
    oracle_.step_errors.push_back(step_errors(oracle_.double_steps.back(), oracle_.steps.back()));
    result_.most_particles = std::max(result_.most_particles, start.state.particles.size());
  }
}

void Agreeing::try_subject(const Subject& subject) {
  SubjectResult result;
  result.subject = subject;
  try {
    measure(subject, result);
  } catch (const DeviceError& failure) {
    result.error = failure.what();
    result.device_failed = true;
  } catch (const std::bad_alloc&) {
    result.error = "out of memory; use fewer particles, or close what else needs memory";
    result.device_failed = true;
  }
  if (stopped_ && result.again == Verdict::not_tried) result.notes.push_back("interrupted");
  result_.subjects.push_back(std::move(result));
}

void Agreeing::measure(const Subject& subject, SubjectResult& result) {
  const std::string& label = subject.plan.label;
  const auto solver = make(subject);
  result.solver = solver->info();
  const Trajectory run = &subject == &subjects_.front() ? oracle_.run : follow_all(*solver, label);
  if (stopped_) return;
  result.solver = solver->info();  // now it knows how many threads there were
  std::vector<OneStep> steps;
  for (const StartState& start : oracle_.starts) steps.push_back(take_one_step(*solver, start.state));
  judge_steps(oracle_, steps, result);
  judge_run(oracle_, run, scene(), result);

  const auto second = make(subject);
  const Trajectory again = follow_all(*second, label + ", again");
  if (stopped_) return;
  result.again = again.hashes == run.hashes ? Verdict::same : Verdict::differs;
  if (result.again == Verdict::differs)
    result.notes.push_back(
        fmt::format("a second run differs first after frame {}", first_other_frame(again.hashes, run.hashes)));
  if (run.error.empty()) {
    result.restart = restart_of(subject, run);
    if (giver_ != nullptr) result.hand_over = hand_over(*second, subject.plan.strict, result.notes);
    if (result.bits != Verdict::differs) {  // whoever takes from a wrong one could not be blamed
      giver_ = &subject;
      given_ = run;
    }
  }
  if (result.bits != Verdict::same) other_runs_[result_.subjects.size()] = run;
}

State Agreeing::through_checkpoint(const State& state) const {
  const Settings& settings = subjects_.front().plan.settings;
  const Checkpoint saved{checkpoint_scene_text(scene(), settings.pressure),
                         settings.pressure,
                         settings.precision,
                         settings.seed,
                         0.0,
                         state};
  return decode_checkpoint(encode_checkpoint(saved), "checkpoint").state;
}

Verdict Agreeing::restart_of(const Subject& subject, const Trajectory& run) {
  const auto solver = make(subject);
  solver->restore(through_checkpoint(run.middle));
  const Trajectory tail = follow(*solver, tail_, {}, every_frame(subject.plan.label + ", restarted"));
  return std::equal(tail.hashes.begin(), tail.hashes.end(), run.hashes.begin() + middle_) ? Verdict::same
                                                                                          : Verdict::differs;
}

/// Goes on from the middle of the subject before. With fewer guarantees on one side, the first frame is held against
/// what the reference makes of the same state.
Verdict Agreeing::hand_over(Solver& solver, bool strict, std::vector<std::string>& notes) {
  const State middle = through_checkpoint(given_.middle);
  solver.restore(middle);
  const std::string doing = "hand-over from " + giver_->plan.label;
  const Trajectory tail = follow(solver, tail_, {1, 0}, every_frame(doing));
  if (std::equal(tail.hashes.begin(), tail.hashes.end(), given_.hashes.begin() + middle_)) return Verdict::same;
  Verdict verdict = Verdict::differs;
  if (!strict || !giver_->plan.strict) {
    reference_->restore(middle);
    const FrameReport& report = reference_->advance(Delivery::nothing);
    const double allowed = rounding_tolerance_dx(scene(), report.substeps, Precision::single_precision);
    const auto apart = distance_between(reference_->state().particles, tail.states.front(), scene().fluid.spacing_m);
    if (apart.max_dx <= allowed) verdict = Verdict::within;
  }
  if (verdict == Verdict::differs) notes.push_back(doing + ": goes on to other water");
  return verdict;
}

void Agreeing::hand_over_to_first() {
  SubjectResult& first = result_.subjects.front();
  if (giver_ == nullptr || giver_ == &subjects_.front())
    first.notes.push_back("no hand-over: nobody to take from");
  else
    first.hand_over = hand_over(*reference_, true, first.notes);
}

/// A run that is rounded otherwise in every sub-step, as by a device that promises no bits.
Trajectory Agreeing::perturbed_run(Solver& solver, int member) {
  const EveryFrame tick = every_frame(fmt::format("perturbed run {}", member));
  std::uint64_t seed = static_cast<std::uint64_t>(member) << 32;
  Trajectory run;
  solver.restore(perturbed(oracle_.start, ++seed));
  for (int frame = 0; frame < result_.settings.frames; ++frame) {
    const std::uint64_t before = solver.clock().frame;
    while (solver.clock().frame == before) {
      solver.advance_substep();
      solver.restore(perturbed(solver.state(), ++seed));
    }
    const double time_s = static_cast<double>(solver.clock().frame) / scene().time.frame_rate_hz;
    run.observations.push_back(observe(scene(), solver.state().particles, time_s));
    if (!tick()) break;
  }
  return run;
}

/// Perturbed runs by the subject that should do them fastest; the noise is that of the water.
void Agreeing::observe_long_runs() {
  const Subject* fastest = &subjects_.front();
  for (std::size_t i = 0; i < subjects_.size(); ++i)
    if (subjects_[i].plan.backend == "omp" && subjects_[i].plan.strict && result_.subjects[i].bits == Verdict::same &&
        subjects_[i].plan.settings.threads >= fastest->plan.settings.threads)
      fastest = &subjects_[i];
  std::vector<Trajectory> ensemble{oracle_.run};
  const auto solver = make(*fastest);
  for (int member = 1; member <= result_.settings.members && !stopped_; ++member)
    ensemble.push_back(perturbed_run(*solver, member));
  if (stopped_) return;
  result_.double_observed = observed_distances(oracle_.double_run, ensemble);
  for (const auto& [index, run] : other_runs_)
    judge_observables(observed_distances(run, ensemble), result_.subjects[index]);
}

std::optional<FirstDifference> Agreeing::locate(const Subject& a, const Subject& b, std::uint64_t frames_before) {
  try {
    const auto first = make(a), second = make(b);
    first->restore(oracle_.start);
    for (std::uint64_t frame = 0; frame < frames_before; ++frame) first->advance(Delivery::nothing);
    return locate_difference(*first, *second, first->state());
  } catch (const DeviceError&) {
    return std::nullopt;
  }
}

/// Every pair by its hashes. Where pairs part in the same frame for the same two hashes, they are looked into once.
void Agreeing::compare_pairs() {
  const auto& subjects = result_.subjects;
  std::map<std::pair<std::uint64_t, std::uint64_t>, FirstDifference> known;
  for (std::size_t i = 0; i < subjects.size(); ++i)
    for (std::size_t j = i + 1; j < subjects.size(); ++j) {
      PairResult pair{i, j, subjects_[i].plan.strict && subjects_[j].plan.strict, false, {}, {}};
      const auto &a = subjects[i].hashes, &b = subjects[j].hashes;
      pair.bitwise = a == b && !a.empty();
      if (const std::size_t frame = first_other_frame(a, b); !pair.bitwise && frame < std::min(a.size(), b.size())) {
        pair.frame = oracle_.start.clock.frame + frame;
        const auto key = std::minmax(a[frame], b[frame]);
        auto found = known.find(key);
        if (found == known.end()) {
          auto located = locate(subjects_[i], subjects_[j], frame);
          if (!located) located = FirstDifference{*pair.frame, 0, {}, false};
          found = known.emplace(key, *located).first;
        }
        pair.difference = found->second;
      }
      result_.pairs.push_back(pair);
    }
}

}  // namespace

AgreeResult agree(const SolverFactory& make, const std::vector<Subject>& subjects, const AgreeSettings& settings,
                  const AgreeProgress& progress) {
  check(subjects, settings);
  return Agreeing(make, subjects, settings, progress).run();
}

}  // namespace squall::harness
