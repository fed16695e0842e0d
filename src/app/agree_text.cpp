#include "app/agree_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/device_choice.h"
#include "app/plans.h"
#include "app/table.h"
#include "app/terminal.h"
#include "harness/agree/agree_results.h"

namespace squall::app {

namespace {

using harness::AgreeResult;
using harness::SubjectResult;

constexpr const char* k_rule = "--------------------------------------------------------------------------------\n";

std::string device_line(const DeviceInfo& device) {
  const std::string promise = device.lacks.empty() ? "promises bits" : "held to tolerances for want of " + device.lacks;
  if (device.backend != "opencl") return fmt::format("{}: {}; {}\n", device.backend, device.name, promise);
  return fmt::format("opencl {}: {} ({}), {}, {}, driver {}; {}\n", device.index, device.name, device.kind,
                     device.platform, device.version, device.driver, promise);
}

std::string devices_text(const AgreeResult& result, const std::vector<BackendInfo>& backends) {
  std::vector<std::string> lines;
  for (const auto& subject : result.subjects) {
    if (subject.subject.plan.backend == "reference") continue;
    const std::string line = device_line(device_of(subject.subject.plan, backends));
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  return fmt::format("{}", fmt::join(lines, ""));
}

std::string head_text(const Workload& workload, const harness::Context& context, const AgreeResult& result) {
  const SubjectResult& first = result.subjects.front();
  return fmt::format("squall agree: {}, {} frames, {} sub-steps\nsquall {} ({}), {}, {}\ncpu: {}, {} threads\n",
                     headline(workload), first.hashes.size(), with_commas(first.substeps), context.squall_version,
                     context.git_revision, context.compiler, context.date, context.cpu, context.threads);
}

/// The worst of all starts.
std::string worst_ulp(const SubjectResult& subject, harness::Ulps harness::StepErrors::*field) {
  double worst = 0.0;
  for (const auto& step : subject.steps) worst = std::max(worst, (step.errors.*field).max);
  return subject.steps.empty() ? "-" : fmt::format("{:.4g}", worst);
}

std::string levels_text(const AgreeResult& result) {
  using harness::StepErrors;
  Table table({"run", "integers", "ulp: density", "pressure", "force", "every bit", "long run", "again", "restart",
               "hand-over"});
  for (const auto& subject : result.subjects) {
    const std::string& label = subject.subject.plan.label;
    if (!subject.error.empty()) {
      table.add_free(label, "error: " + subject.error);
      continue;
    }
    table.add({label, to_string(subject.integers), worst_ulp(subject, &StepErrors::density),
               worst_ulp(subject, &StepErrors::pressure), worst_ulp(subject, &StepErrors::force),
               to_string(subject.bits), to_string(subject.long_run), to_string(subject.again),
               to_string(subject.restart), to_string(subject.hand_over)});
  }
  return table.text();
}

std::string growth_text(const char* what, const std::vector<harness::Distance>& growth) {
  std::string text = fmt::format("{}, rms (largest) dx:", what);
  for (std::size_t frame = 1; frame <= growth.size(); frame += frame < 2 ? 1 : frame < 5 ? 3 : 5)
    text += fmt::format(" {:.2g} ({:.2g}) after {};", growth[frame - 1].rms_dx, growth[frame - 1].max_dx, frame);
  text.back() = '\n';
  return text;
}

std::string observed_text(const std::vector<harness::ObservedDistance>& observed, int members) {
  std::string outside;
  for (const auto& one : observed)
    if (!one.within()) outside += fmt::format(" {} by {:.3g}, floor {:.3g};", one.what, one.distance, one.floor);
  if (outside.empty())
    return fmt::format("long run: all {} observables within the noise floor of {} perturbed runs\n", observed.size(),
                       members);
  outside.back() = '\n';
  return fmt::format("long run: beyond the noise floor of {} perturbed runs:{}", members, outside);
}

std::string single_text(const AgreeResult& result) {
  if (result.double_growth.empty() || result.double_observed.empty()) return "";
  return growth_text("single from double precision", result.double_growth) + "single from double precision, " +
         observed_text(result.double_observed, result.settings.members);
}

std::string notes_text(const AgreeResult& result) {
  std::string text;
  for (const auto& subject : result.subjects) {
    const std::string& label = subject.subject.plan.label;
    for (const auto& note : subject.notes) text += fmt::format("{}: {}\n", label, note);
    if (!subject.growth.empty()) text += label + ": " + growth_text("from the reference", subject.growth);
    if (!subject.observed.empty()) text += label + ": " + observed_text(subject.observed, result.settings.members);
  }
  return text;
}

/// Each place where pairs part once, with the first pair that does.
std::string pairs_text(const AgreeResult& result) {
  std::string text;
  std::set<std::string> told;
  for (const auto& pair : result.pairs) {
    if (!pair.difference) continue;
    const std::string place = harness::difference_text(*pair.difference);
    if (!told.insert(place).second) continue;
    text += fmt::format("{} and {} part in {}\n", result.subjects[pair.first].subject.plan.label,
                        result.subjects[pair.second].subject.plan.label, place);
  }
  const auto bitwise = std::count_if(result.pairs.begin(), result.pairs.end(), [](const auto& p) { return p.bitwise; });
  return text + (result.interrupted ? "" : fmt::format("pairs: {} of {} bitwise\n", bitwise, result.pairs.size()));
}

}  // namespace

std::string agree_text(const Workload& workload, const harness::Context& context,
                       const std::vector<BackendInfo>& backends, const AgreeResult& result) {
  if (result.subjects.empty()) return harness::verdict_text(result) + "\n";
  const std::string verdict = harness::verdict_text(result);
  return k_rule + head_text(workload, context, result) + devices_text(result, backends) + "\n" + levels_text(result) +
         "\n" + single_text(result) + notes_text(result) + pairs_text(result) +
         (result.agree() ? bold(verdict) : red(verdict)) + "\n" + k_rule;
}

}  // namespace squall::app
