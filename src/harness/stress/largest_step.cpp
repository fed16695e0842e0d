#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "harness/stress/largest_step.h"

namespace squall::harness {

namespace {

/// One search, with its place in it.
class Search {
 public:
  Search(const StepSetting& setting, const StressFactory& make, bool quick, const StepProgress& progress)
      : make_(make), quick_(quick), progress_(progress) {
    result_.setting = setting;
    result_.theory = step_theory(setting, quick);
  }

  std::optional<StepResult> run() {
    const auto start = std::chrono::steady_clock::now();
    if (!search()) return std::nullopt;
    if (low_ == 0.0 && !allow_what_the_model_gains()) return std::nullopt;
    if (result_.gain_anyway > 0.0 && !search()) return std::nullopt;
    result_.largest_s = low_;
    result_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result_;
  }

 private:
  /// False if it was ended.
  bool search() {
    const StepTrial taken = trial_of(0.0, allowed_gain_);
    result_.taken_s = taken.longest_s;
    result_.taken_breaks = taken.trouble;
    return !taken.ended && bracket() && bisect();
  }

  bool allow_what_the_model_gains() {
    const StepTrial fine = trial_of(0.125 * result_.taken_s, std::numeric_limits<double>::infinity());
    if (!fine.trouble.empty()) {
      result_.breaks = fine.trouble;
    } else if (fine.gain > k_allowed_gain) {
      result_.gain_anyway = fine.gain;
      allowed_gain_ = 2.0 * fine.gain;
    }
    return !fine.ended;
  }

  StepTrial trial_of(double step_s, double allowed_gain) {
    constexpr double k_trials = 12.0;  // of a search, about
    const auto go_on = [this] { return !progress_ || progress_(std::min(1.0, trials_ / k_trials)); };
    StepTrial trial = try_step(result_.setting, make_, step_s, quick_, allowed_gain, go_on);
    trials_ += 1.0;
    return trial;
  }

  /// nullopt if the search was ended.
  std::optional<bool> is_stable(double step_s) {
    const StepTrial trial = trial_of(step_s, allowed_gain_);
    if (trial.ended) return std::nullopt;
    if (trial.trouble.empty()) return true;
    result_.breaks = trial.trouble;
    return false;
  }

  /// low_ is stable, or 0 where nothing is; high_ is not, or equal to low_ where everything is.
  bool bracket() {
    constexpr double k_furthest = 64.0, k_nearest = 1.0 / 32.0;
    low_ = high_ = result_.taken_s;
    auto stable = is_stable(low_);
    while (stable && *stable && high_ < k_furthest * result_.taken_s) {
      stable = is_stable(2.0 * high_);
      if (stable && *stable) low_ *= 2.0;
      high_ *= 2.0;
    }
    if (!stable) return false;
    if (*stable) {
      high_ = low_;
      result_.at_end = true;
      return true;
    }
    if (high_ > low_) return true;
    while (!*stable) {
      high_ = low_;
      low_ *= 0.5;
      if (low_ < k_nearest * result_.taken_s) {
        low_ = high_ = 0.0;
        return true;
      }
      stable = is_stable(low_);
      if (!stable) return false;
    }
    return true;
  }

  bool bisect() {
    const double precision = quick_ ? 1.1 : 1.02;
    while (high_ > precision * low_) {
      const double middle = std::sqrt(low_ * high_);
      const auto stable = is_stable(middle);
      if (!stable) return false;
      (*stable ? low_ : high_) = middle;
    }
    return true;
  }

  const StressFactory& make_;
  bool quick_;
  const StepProgress& progress_;
  StepResult result_;
  double allowed_gain_ = k_allowed_gain;
  double low_ = 0.0, high_ = 0.0, trials_ = 0.0;
};

}  // namespace

std::optional<StepResult> find_largest_step(const StepSetting& setting, const StressFactory& make, bool quick,
                                            const StepProgress& progress) {
  return Search(setting, make, quick, progress).run();
}

}  // namespace squall::harness
