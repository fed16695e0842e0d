#include "harness/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace squall::harness {

namespace {

std::vector<std::size_t> order_by_id(const Particles& particles) {
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return particles.ids[a] < particles.ids[b]; });
  return order;
}

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Distance, infinite for a value that is no number: NaN would lose every comparison.
double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length = (a - b).norm();
  return std::isfinite(length) ? length : k_infinity;
}

class Differences {
 public:
  explicit Differences(double spacing) : spacing_(spacing) {}
  void only_in_one(std::uint32_t id) { note(id, k_infinity, k_infinity); }
  void in_both(const Particles& a, std::size_t i, const Particles& b, std::size_t j) {
    if (a.positions[i] == b.positions[j] && a.velocities[i] == b.velocities[j]) return;
    note(a.ids[i], distance(a.positions[i], b.positions[j]) / spacing_, distance(a.velocities[i], b.velocities[j]));
  }
  const std::optional<Difference>& result() const { return result_; }

 private:
  void note(std::uint32_t id, double position_dx, double velocity) {
    if (!result_) result_ = Difference{id, 0.0, 0.0};
    result_->max_position_error_dx = std::max(result_->max_position_error_dx, position_dx);
    result_->max_velocity_error = std::max(result_->max_velocity_error, velocity);
  }
  double spacing_;
  std::optional<Difference> result_;
};

/// Index of the frame that a run did last, from 0.
std::uint64_t last_frame(const Run& run) { return run.state().clock.frame - 1; }

std::string frames_text(int count) { return fmt::format("{} frame{}", count, count == 1 ? "" : "s"); }

std::string who_stopped(const std::vector<const Run*>& runs) {
  std::string list;
  std::size_t count = 0;
  bool together = true;
  for (const Run* run : runs) {
    if (run->error().empty()) continue;
    ++count;
    together = together && run->steps_done() == runs.front()->steps_done();
    list += fmt::format("{}{} after {}", list.empty() ? "" : ", ", run->plan().label, frames_text(run->steps_done()));
  }
  if (count == 0) return {};
  if (count == runs.size() && together)
    return "; all failed and stopped after " + frames_text(runs.front()->steps_done());
  return "; failed and stopped: " + list;
}

}  // namespace

std::optional<Difference> difference_between(const Particles& a, const Particles& b, double spacing) {
  const auto order_a = order_by_id(a), order_b = order_by_id(b);
  Differences differences(spacing);
  std::size_t i = 0, j = 0;
  while (i < order_a.size() || j < order_b.size()) {
    if (j == order_b.size() || (i < order_a.size() && a.ids[order_a[i]] < b.ids[order_b[j]]))
      differences.only_in_one(a.ids[order_a[i++]]);
    else if (i == order_a.size() || b.ids[order_b[j]] < a.ids[order_a[i]])
      differences.only_in_one(b.ids[order_b[j++]]);
    else
      differences.in_both(a, order_a[i++], b, order_b[j++]);
  }
  return differences.result();
}

double rounding_tolerance_dx(const Scene& scene, int substeps, Precision precision) {
  constexpr double k_roundings_per_substep = 16.0;
  const double epsilon = precision == Precision::single_precision ? std::numeric_limits<float>::epsilon()
                                                                  : std::numeric_limits<double>::epsilon();
  const double coordinate_dx = scene.container_size().maxCoeff() / scene.fluid.spacing_m;
  return k_roundings_per_substep * substeps * epsilon * coordinate_dx;
}

void AgreementCheck::after_round(const std::vector<const Run*>& runs) {
  ++rounds_;
  std::vector<const Run*> taking_part;
  for (const Run* run : runs)
    if (run->plan().backend != "reference") taking_part.push_back(run);
  stopped_ = who_stopped(taking_part);
  compare_precision(Precision::single_precision, taking_part, single_);
  compare_precision(Precision::double_precision, taking_part, double_);
}

void AgreementCheck::compare_precision(Precision precision, const std::vector<const Run*>& runs, Strict& found) {
  std::vector<const Run*> strict, tolerant;
  for (const Run* run : runs)
    if (run->plan().settings.precision == precision && run->steps_done() == rounds_)
      (run->plan().strict ? strict : tolerant).push_back(run);
  if (strict.size() > 1) {
    ++found.frames;
    found.runs = std::max(found.runs, strict.size());
    compare_bits(strict, found);
    compare_failures(strict, found);
  }
  if (rounds_ > 1 || strict.empty()) return;
  tolerant_runs_ += tolerant.size();
  for (const Run* run : tolerant) compare_by_tolerance(*strict.front(), *run);
}

void AgreementCheck::compare_bits(const std::vector<const Run*>& strict, Strict& found) {
  if (!found.bitwise) found.bitwise = true;
  if (!*found.bitwise) return;
  const Run& expected = *strict.front();
  const auto other = std::find_if(strict.begin(), strict.end(),
                                  [&](const Run* run) { return run->state_hash() != expected.state_hash(); });
  if (other == strict.end()) return;
  found.bitwise = agreement_.agree = false;
  if (!first_label_.empty()) return;
  agreement_.first_difference_frame = last_frame(expected);
  agreement_.difference =
      difference_between(expected.state().particles, (*other)->state().particles, expected.scene().fluid.spacing_m);
  first_label_ = expected.plan().label;
  second_label_ = (*other)->plan().label;
}

void AgreementCheck::compare_failures(const std::vector<const Run*>& strict, Strict& found) {
  const auto has_failed = [](const Run* run) { return !run->error().empty(); };
  const auto failed = std::find_if(strict.begin(), strict.end(), has_failed);
  const auto sound = std::find_if_not(strict.begin(), strict.end(), has_failed);
  if (failed == strict.end() || sound == strict.end() || !failed_in_one_.empty()) return;
  found.bitwise = agreement_.agree = false;
  if (!agreement_.first_difference_frame) agreement_.first_difference_frame = last_frame(**failed);
  failed_in_one_ = fmt::format("; {} failed in frame {} where {} did not", (*failed)->plan().label,
                               last_frame(**failed), (*sound)->plan().label);
}

void AgreementCheck::compare_by_tolerance(const Run& expected, const Run& run) {
  const double spacing = expected.scene().fluid.spacing_m;
  const auto difference = difference_between(expected.state().particles, run.state().particles, spacing);
  const double tolerance = rounding_tolerance_dx(
      expected.scene(), std::max(1, expected.state().clock.previous_substeps), expected.plan().settings.precision);
  if (!difference || difference->max_position_error_dx <= tolerance) return;
  agreement_.agree = false;
  out_of_tolerance_ +=
      fmt::format("; {} is {:.3g} dx away from {} after the first frame, {:.3g} dx allowed", run.plan().label,
                  difference->max_position_error_dx, expected.plan().label, tolerance);
}

std::string AgreementCheck::same_bits_text() const {
  const std::string in_single =
      single_.bitwise ? fmt::format("{} runs after each of {}", single_.runs, frames_text(single_.frames)) : "";
  const std::string in_double = double_.bitwise ? fmt::format("{} double-precision runs after each of {}", double_.runs,
                                                              frames_text(double_.frames))
                                                : "";
  return "same bits in " + in_single + (single_.bitwise && double_.bitwise ? ", and in " : "") + in_double;
}

Agreement AgreementCheck::result() const {
  Agreement result = agreement_;
  if (single_.bitwise || double_.bitwise)
    result.bitwise = single_.bitwise.value_or(true) && double_.bitwise.value_or(true);
  if (!result.bitwise) {
    result.verdict = "nothing to compare bit by bit: fewer than two strict runs of one precision did a frame";
  } else if (first_label_.empty()) {
    result.verdict = same_bits_text();
  } else {
    result.verdict = fmt::format("{} and {} differ first after frame {}", first_label_, second_label_,
                                 *result.first_difference_frame);
    if (result.difference)
      result.verdict += fmt::format(", particle {}: up to {:.3g} dx and {:.3g} m/s", result.difference->particle,
                                    result.difference->max_position_error_dx, result.difference->max_velocity_error);
  }
  result.verdict += failed_in_one_ + out_of_tolerance_;
  if (tolerant_runs_ > 0 && out_of_tolerance_.empty())
    result.verdict += fmt::format("; {} run(s) within tolerance after the first frame", tolerant_runs_);
  result.verdict += stopped_;
  return result;
}

}  // namespace squall::harness
