#include "app/comparison_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "app/result_output.h"
#include "app/row_text.h"
#include "app/table.h"
#include "app/terminal.h"

namespace squall::app {

namespace {

using harness::Row;

std::string devices_text(const std::vector<Row>& rows) {
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string line = row.plan.backend;
    if (row.plan.backend == "opencl") line += " " + row.plan.settings.device;
    line += ": " + (row.solver.device.empty() ? "not started" : row.solver.device);
    if (!row.solver.simd.empty()) line += ", " + row.solver.simd;
    if (!row.plan.strict) line += ", compared by tolerance";
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::string exposed_text(const Row& row) {
  if (!row.exposed_readback_ms) return "-";
  std::string text = fmt::format("{:+.3f}", *row.exposed_readback_ms);
  if (const auto& interval = row.exposed_readback_interval_ms)
    text += fmt::format(" [{:+.3f}, {:+.3f}]", interval->low, interval->high);
  return text;
}

std::string times_text(const std::vector<Row>& rows) {
  const bool with_error =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.position_error_dx.has_value(); });
  std::vector<std::string> header{
      "run",        "threads",      "frame ms",          "p95",      "p99", "max", "fps", "x real",
      "compute ms", "read-back ms", "exposed ms [95 %]", "M steps/s"};
  if (with_error) header.push_back("error dx");
  Table table(header);
  for (const auto& row : rows) {
    if (!row.error.empty()) {
      table.add_free(row.plan.label, "error: " + row.error);
      continue;
    }
    std::vector<std::string> cells{row.plan.label,
                                   std::to_string(row.solver.threads),
                                   fmt::format("{:.2f}", row.frame_ms.median),
                                   fmt::format("{:.2f}", row.frame_ms.p95),
                                   fmt::format("{:.2f}", row.frame_ms.p99),
                                   fmt::format("{:.2f}", row.frame_ms.max),
                                   fmt::format("{:.1f}", row.fps),
                                   fmt::format("{:.2f}", row.realtime_factor),
                                   fmt::format("{:.2f}", row.compute_ms.median),
                                   fmt::format("{:.3f}", row.readback_ms.median),
                                   exposed_text(row),
                                   fmt::format("{:.2f}", row.particle_steps_per_s / 1e6)};
    if (with_error) cells.push_back(row.position_error_dx ? fmt::format("{:.3g}", *row.position_error_dx) : "-");
    table.add(std::move(cells));
  }
  return table.text();
}

std::string optional_text(const std::optional<double>& value, int decimals, double scale = 1.0) {
  return value ? fmt::format("{:.{}f}", scale * *value, decimals) : "-";
}

/// How positions came to the host; empty where every run delivers in place.
std::string readback_text(const std::vector<Row>& rows) {
  Table table({"read-back", "kB delivered", "kB copied", "copy ms (separate run)", "hidden %", "frames late"});
  bool any = false;
  for (const auto& row : rows) {
    if (row.plan.backend != "opencl" || !row.error.empty()) continue;
    any = true;
    table.add({row.plan.label, fmt::format("{:.1f}", row.readback_bytes_per_frame / 1e3),
               fmt::format("{:.1f}", row.readback_copied_bytes_per_frame / 1e3), optional_text(row.readback_copy_ms, 3),
               optional_text(row.readback_overlap, 0, 100.0), std::to_string(row.readback_latency_frames)});
  }
  return any ? table.text() + "\n" : "";
}

std::string budget_text(const std::vector<Row>& rows, double budget_ms) {
  std::vector<std::string> fitting;
  for (const auto& row : rows)
    if (keeps_budget(row, budget_ms)) fitting.push_back(row.plan.label);
  if (fitting.empty())
    return red(fmt::format("budget {} ms: no run keeps it at the 95th percentile", budget_ms)) + "\n";
  return fmt::format("budget {} ms: kept at the 95th percentile by {}\n", budget_ms, fmt::join(fitting, "; "));
}

}  // namespace

std::string comparison_text(const harness::Comparison& comparison, std::optional<double> budget_ms) {
  const auto& rows = comparison.rows;
  std::string text = devices_text(rows);
  const auto good = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.error.empty(); });
  if (good != rows.end())
    text += fmt::format("{} frames after {} uncounted ones: {:.3f} s simulated, {} sub-steps\n", good->frames,
                        good->plan.warm_up_frames, good->simulated_s, with_commas(good->steps));
  text += "\n" + times_text(rows) + "\n" + readback_text(rows);
  if (const auto phases = phases_text(rows); !phases.empty()) text += phases + "\n";
  if (good != rows.end()) text += water_text(*good) + "\n";
  const std::string verdict = "agreement: " + comparison.agreement.verdict;
  text += (comparison.agreement.agree ? bold(verdict) : red(verdict)) + "\n";
  if (budget_ms) text += budget_text(rows, *budget_ms);
  return text;
}

}  // namespace squall::app
