#include "app/row_text.h"

#include <fmt/format.h>

#include <set>

#include "app/table.h"
#include "app/terminal.h"
#include "core/state_hash.h"
#include "harness/results_json.h"
#include "harness/water_warnings.h"

namespace squall::app {

namespace {

std::vector<std::string> tail_cells(const std::string& name, const harness::Tail& tail) {
  return {name, fmt::format("{:.3f}", tail.median), fmt::format("{:.3f}", tail.p95), fmt::format("{:.3f}", tail.p99),
          fmt::format("{:.3f}", tail.max)};
}

std::string solver_text(const harness::Row& row) {
  std::string text = fmt::format("{} on {}", row.plan.label, row.solver.device);
  if (!row.solver.simd.empty()) text += ", " + row.solver.simd;
  if (row.solver.threads > 0) text += fmt::format(", threads used: {}", row.solver.threads);
  if (row.solver.setup_ms > 0.0) text += fmt::format(", set up in {:.0f} ms", row.solver.setup_ms);
  return text;
}

std::string times_text(const harness::Row& row) {
  Table table({"ms per frame", "median", "p95", "p99", "max"});
  table.add(tail_cells("frame", row.frame_ms));
  table.add(tail_cells("  compute", row.compute_ms));
  table.add(tail_cells("  read-back", row.readback_ms));
  table.add(tail_cells("  upload", row.upload_ms));
  return table.text();
}

std::string readback_text(const harness::Row& row) {
  std::string text = fmt::format("read-back {}: {:.1f} kB delivered per frame, {:.1f} kB copied, {:.2g} % of the time",
                                 harness::readback_name(row), row.readback_bytes_per_frame / 1e3,
                                 row.readback_copied_bytes_per_frame / 1e3, 100.0 * row.readback_share);
  if (row.readback_latency_frames > 0)
    text += fmt::format(", {} frame{} late", row.readback_latency_frames, row.readback_latency_frames > 1 ? "s" : "");
  if (row.readback_overlap) text += fmt::format(", {:.0f} % of the copying hidden", 100.0 * *row.readback_overlap);
  return text;
}

std::string iterations_text(const harness::Row& row) {
  std::string text =
      fmt::format("dfsph: iterations per sub-step, density mean {:.2f} (max {}), divergence mean {:.2f} (max {})",
                  row.density_iterations_mean, row.density_iterations_max, row.divergence_iterations_mean,
                  row.divergence_iterations_max);
  if (row.light_pass_ns)
    text +=
        fmt::format("; {:.1f} light passes, {:.2f} ns per particle each", row.light_passes_mean, *row.light_pass_ns);
  for (const auto& warning : harness::water_warnings(row)) text += "\n" + red("warning: " + warning);
  return text;
}

}  // namespace

std::vector<std::string> water_notes(const std::vector<harness::Row>& rows) {
  std::vector<std::string> notes;
  std::set<std::string> told;
  for (const auto& row : rows)
    for (const auto& text : harness::water_warnings(row))
      if (told.insert(text).second) notes.push_back(fmt::format("{}: {}", row.plan.label, text));
  return notes;
}

std::string water_text(const harness::Row& row) {
  std::string text =
      fmt::format("water: density error mean {:.3g} %, max {:.3g} %, {:.1f} neighbours, {} clamps, {} lost",
                  100.0 * row.density_error_mean, 100.0 * row.density_error_max, row.neighbours_mean,
                  with_commas(row.clamps), row.lost_particles);
  if (row.energy_drift) text += fmt::format(", energy {:+.2f} %", 100.0 * *row.energy_drift);
  if (row.plan.settings.pressure == Pressure::dfsph) text += "\n" + iterations_text(row);
  return text;
}

std::string run_text(const harness::Row& row) {
  std::string text = solver_text(row) + "\n";
  if (!row.error.empty()) return text + red("error: " + row.error) + "\n";
  text += fmt::format("{} frames, {} sub-steps: {:.3f} s simulated in {:.3f} s, {:.2f} times real time, {:.1f} fps\n\n",
                      with_commas(row.frames), with_commas(row.steps), row.simulated_s, row.wall_s, row.realtime_factor,
                      row.fps);
  text += times_text(row) + "\n";
  text += fmt::format("{:.2f} M particle-steps/s, {:.0f} M pairs/s\n", row.particle_steps_per_s / 1e6,
                      row.pairs_per_s / 1e6);
  text += readback_text(row) + "\n";
  text += water_text(row) + "\n";
  text += "state " + hash_text(row.state_hash) + "\n";
  const auto phases = phases_text({row});
  return phases.empty() ? text : text + "\n" + phases;
}

std::string phases_text(const std::vector<harness::Row>& rows) {
  std::set<std::string> phases;
  for (const auto& row : rows)
    for (const auto& entry : row.phase_ms) phases.insert(entry.first);
  if (phases.empty()) return "";
  std::vector<std::string> header{"ms per phase (separate run)"};
  header.insert(header.end(), phases.begin(), phases.end());
  Table table(header);
  for (const auto& row : rows) {
    if (row.phase_ms.empty()) continue;
    std::vector<std::string> cells{row.plan.label};
    for (const auto& phase : phases)
      cells.push_back(row.phase_ms.contains(phase) ? fmt::format("{:.3f}", row.phase_ms.at(phase)) : "-");
    table.add(std::move(cells));
  }
  return table.text();
}

}  // namespace squall::app
