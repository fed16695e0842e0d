#include "app/largest_step_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/table.h"
#include "app/terminal.h"

namespace squall::app {

namespace {

using harness::StepResult;

std::string milliseconds(double seconds) { return std::isfinite(seconds) ? fmt::format("{:.3g}", 1e3 * seconds) : "-"; }

std::string share(double value) { return std::isfinite(value) && value > 0.0 ? fmt::format("{:.2f}", value) : "-"; }

std::vector<std::string> cells_of(const StepResult& result) {
  const auto& setting = result.setting;
  const auto& theory = result.theory;
  const std::string most = result.largest_s > 0.0 ? milliseconds(result.largest_s) : "none";
  return {setting.subject.label,
          setting.signal_m_s > 0.0 ? fmt::format("{:g}", setting.signal_m_s) : "-",
          fmt::format("{:.3g}", setting.viscosity_m2_s),
          setting.subject.settings.precision == Precision::single_precision ? "single" : "double",
          (result.at_end ? ">= " : "") + most,
          share(result.largest_s / theory.sound_s),
          share(result.largest_s / theory.viscous_s),
          share(result.largest_s / theory.force_s),
          share(result.largest_s / theory.motion_s),
          fmt::format("{} {}", share(result.of_theory()), theory.smallest_name()),
          milliseconds(result.taken_s),
          (result.taken_breaks.empty() ? share(result.margin()) : "unstable") + (result.gain_anyway > 0.0 ? " *" : "")};
}

std::string account_of(const StepResult& result) {
  std::string text = result.taken_breaks.empty() ? "" : "squall's own steps " + result.taken_breaks + "; ";
  if (result.breaks.empty()) return text + "no step tried breaks it";
  return text + (result.largest_s > 0.0 ? "beyond it " : "an eighth of them ") + result.breaks;
}

std::string verdict_of(const std::vector<StepResult>& results) {
  const auto defects = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.is_defect(); });
  if (defects > 0) return red(fmt::format("{} of squall's own steps are not stable\n", defects));
  double least = std::numeric_limits<double>::infinity();
  for (const auto& result : results)
    if (result.taken_breaks.empty() && result.largest_s > 0.0) least = std::min(least, result.margin());
  const auto hopeless = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.largest_s == 0.0; });
  std::string text;
  const auto gaining = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.gain_anyway > 0.0; });
  if (gaining > 0)
    text += fmt::format("* gains energy at every step; twice that of short steps is allowed ({} settings)\n", gaining);
  if (hopeless > 0) text += fmt::format("unstable at every step that was tried: {} settings\n", hopeless);
  if (std::isfinite(least))
    text += fmt::format("{}squall's own steps are stable; the least margin is {:.2f}\n",
                        hopeless > 0 ? "elsewhere " : "", least);
  return text;
}

}  // namespace

std::string largest_step_text(const std::vector<StepResult>& results) {
  if (results.empty()) return "";
  Table table({"run", "c m/s", "nu m2/s", "precision", "largest ms", "of sound", "of viscosity", "of force",
               "of motion", "of least", "squall's ms", "margin"});
  std::string text, label, breaks;
  for (const auto& result : results) {
    const auto& subject = result.setting.subject;
    if (label.find(subject.backend) == std::string::npos) label += (label.empty() ? "" : ", ") + subject.backend;
    table.add(cells_of(result));
    breaks += fmt::format("{}, c {:g} m/s, nu {:.3g} m2/s, {}: {}\n", subject.label, result.setting.signal_m_s,
                          result.setting.viscosity_m2_s, to_string(subject.settings.precision), account_of(result));
  }
  return fmt::format("largest stable time step on {}\n\n{}\n{}\n{}", label, table.text(), breaks, verdict_of(results));
}

}  // namespace squall::app
