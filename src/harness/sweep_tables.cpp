#include "harness/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/state_hash.h"
#include "harness/report/plain_text.h"

namespace squall::harness {

namespace {

constexpr const char* k_nothing = "-";

const SweepPoint* find_point(const Sweep& sweep, const SizeInfo& size, const std::string& label) {
  const auto found = std::find_if(sweep.points.begin(), sweep.points.end(), [&](const SweepPoint& point) {
    return point.size.scene_hash == size.scene_hash && point.row.plan.label == label;
  });
  return found == sweep.points.end() ? nullptr : &*found;
}

std::string fit_text(BudgetFit fit) {
  return fit == BudgetFit::all      ? "all"
         : fit == BudgetFit::none   ? "none"
         : fit == BudgetFit::within ? "some"
                                    : "not measured";
}

template <class Cell>
ResultTable size_table(const SweepResult& result, const std::string& title, Cell cell) {
  ResultTable table{title, {"particles"}, {}};
  for (const auto& run : result.plan.runs) table.header.push_back(run.label);
  for (const auto& size : result.sweep.sizes) {
    std::vector<std::string> cells{count_text(size.size, size.particles)};
    for (const auto& run : result.plan.runs) {
      const SweepPoint* point = find_point(result.sweep, size.size, run.label);
      const bool failed = point != nullptr && !point->row.error.empty();
      const bool measured = point != nullptr && is_measured(point->row);
      cells.push_back(failed ? "error" : measured ? cell(*point) : k_nothing);
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

std::vector<ResultTable> size_tables(const SweepResult& result) {
  const auto four_digits = [](double value) {
    return value < 1000.0 ? fmt::format("{:.4g}", value) : readable_number(value);
  };
  std::vector<ResultTable> tables;
  tables.push_back(
      size_table(result, "frames per second", [&](const SweepPoint& point) { return four_digits(point.row.fps); }));
  const auto& points = result.sweep.points;
  if (std::any_of(points.begin(), points.end(), [](const SweepPoint& point) { return point.speedup.has_value(); }))
    tables.push_back(size_table(result, "speed-up against omp with 1 thread", [](const SweepPoint& point) {
      return point.speedup ? fmt::format("{:.2f}", *point.speedup) : std::string(k_nothing);
    }));
  tables.push_back(size_table(result, "milliseconds per frame (median)",
                              [&](const SweepPoint& point) { return four_digits(point.row.frame_ms.median); }));
  tables.push_back(size_table(result, "times real time", [](const SweepPoint& point) {
    return fmt::format("{:.3g}", point.row.realtime_factor);
  }));
  return tables;
}

ResultTable point_table(const SweepResult& result) {
  ResultTable table{"every point",
                    {"run", "particles", "threads used", "frame ms", "p95", "p99", "max", "fps", "x real", "compute ms",
                     "read-back", "read-back ms", "M particle-steps/s", "state"},
                    {}};
  const auto ms = [](double value) { return fmt::format("{:.3f}", value); };
  for (const auto& point : result.sweep.points) {
    const Row& row = point.row;
    std::vector<std::string> cells{row.plan.label, count_text(point.size, row.particles),
                                   std::to_string(row.solver.threads)};
    if (is_measured(row))
      cells.insert(cells.end(),
                   {ms(row.frame_ms.median), ms(row.frame_ms.p95), ms(row.frame_ms.p99), ms(row.frame_ms.max),
                    fmt::format("{:.1f}", row.fps), fmt::format("{:.3g}", row.realtime_factor),
                    ms(row.compute_ms.median), readback_name(row), ms(row.readback_ms.median),
                    fmt::format("{:.2f}", row.particle_steps_per_s / 1e6), hash_text(row.state_hash)});
    else
      cells.push_back(row.error.empty() ? "interrupted" : "error: " + row.error);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

ResultTable lead_table(const SweepResult& result) {
  ResultTable table{"OpenCL against OpenMP", {"run", "particles", "against", "times its speed", "95 % interval"}, {}};
  for (const auto& crossover : result.sweep.crossovers)
    for (const auto& lead : crossover.leads)
      table.rows.push_back({crossover.label, count_text(lead.particles), lead.against,
                            fmt::format("{:.3f}", lead.ratio),
                            lead.interval ? fmt::format("{:.3f} to {:.3f}", lead.interval->low, lead.interval->high)
                                          : std::string(k_nothing)});
  return table;
}

ResultTable budget_table(const SweepResult& result) {
  ResultTable table{
      "largest scene within the budget", {"run", "particles", "frame ms", "p95", "interpolated", "sizes that fit"}, {}};
  for (const auto& entry : result.sweep.budget) {
    std::vector<std::string> cells{entry.label, k_nothing, k_nothing, k_nothing, k_nothing, fit_text(entry.fit)};
    if (entry.largest) {
      const Row& row = entry.largest->row;
      cells[1] = count_text(entry.largest->size, row.particles) + (entry.fit == BudgetFit::all ? " or more" : "");
      cells[2] = fmt::format("{:.2f}", row.frame_ms.median);
      cells[3] = fmt::format("{:.2f}", row.frame_ms.p95);
    }
    if (entry.estimate_particles) cells[4] = readable_number(*entry.estimate_particles);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace squall::harness
