#include "harness/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/report/html_report.h"
#include "harness/report/plain_text.h"
#include "harness/sweep_tables.h"

namespace squall::harness {

namespace {

/// Threads of OpenMP are shades of blue, devices are colours of their own, the reference is black.
std::vector<std::string> colours_of(const std::vector<RunPlan>& runs) {
  const auto omp = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const RunPlan& run) { return run.backend == "omp"; }));
  std::vector<std::string> colours;
  std::size_t omp_so_far = 0, others_so_far = 0;
  for (const auto& run : runs)
    colours.push_back(run.backend == "omp"         ? blue_shade(omp_so_far++, omp)
                      : run.backend == "reference" ? "#000000"
                                                   : palette_colour(1 + others_so_far++ % 5));
  return colours;
}

template <class Value>
std::vector<Series> series_of(const SweepResult& result, Value value) {
  std::vector<Series> all;
  const auto colours = colours_of(result.plan.runs);
  for (std::size_t i = 0; i < result.plan.runs.size(); ++i) {
    Series series{result.plan.runs[i].label, {}, colours[i]};
    for (const auto& point : result.sweep.points)
      if (point.row.plan.label == series.name && is_measured(point.row)) value(point, series);
    all.push_back(std::move(series));
  }
  return all;
}

Sample sample_at(const SweepPoint& point, double y) {
  return {static_cast<double>(point.row.particles), y, {}, {}, ""};
}

Plot against_particles(const SweepResult& result, const std::string& name, const std::string& what, const Axis& y) {
  Plot plot;
  plot.name = name;
  plot.title = result.scene.name + ": " + what;
  plot.x = {"particles", true};
  plot.y = y;
  return plot;
}

Plot fps_plot(const SweepResult& result) {
  Plot plot = against_particles(result, "fps", "frames per second against particles",
                                {"frames per second (median frame)", true});
  plot.series = series_of(result, [](const SweepPoint& point, Series& series) {
    series.samples.push_back(sample_at(point, point.row.fps));
  });
  plot.marks = {{fmt::format("real time: {:.4g} frames per second", result.frame_rate_hz), result.frame_rate_hz}};
  return plot;
}

Plot speedup_plot(const SweepResult& result) {
  Plot plot = against_particles(result, "speedup", "speed-up against one OpenMP thread",
                                {"times as fast as omp, 1 thread", false, true});
  plot.series = series_of(result, [](const SweepPoint& point, Series& series) {
    if (point.speedup) series.samples.push_back(sample_at(point, *point.speedup));
  });
  return plot;
}

/// Rings around the largest scenes that were measured within the budget, in the colours of their runs.
void add_rings(const SweepResult& result, Plot& plot) {
  const auto runs = plot.series;
  for (const auto& entry : result.sweep.budget) {
    if (entry.fit != BudgetFit::within || !entry.largest) continue;
    const auto run = std::find_if(runs.begin(), runs.end(), [&](const Series& s) { return s.name == entry.label; });
    Series ring;
    ring.samples = {sample_at(*entry.largest, entry.largest->row.frame_ms.median)};
    ring.colour = run->colour;
    ring.line = false;
    ring.ring = true;
    plot.series.push_back(std::move(ring));
  }
}

Plot frame_time_plot(const SweepResult& result) {
  Plot plot = against_particles(result, "frame_time", "frame time against particles",
                                {"frame time [ms]: median, bar to 95th percentile", true});
  plot.series = series_of(result, [](const SweepPoint& point, Series& series) {
    const Tail& ms = point.row.frame_ms;
    series.samples.push_back({static_cast<double>(point.row.particles), ms.median, ms.median, ms.p95, ""});
    series.spread = Spread::bars;
  });
  if (result.plan.budget_ms)
    plot.marks = {{fmt::format("budget {:.4g} ms", *result.plan.budget_ms), *result.plan.budget_ms}};
  add_rings(result, plot);
  return plot;
}

Plot realtime_plot(const SweepResult& result) {
  Plot plot = against_particles(result, "realtime_factor", "simulated seconds per second against particles",
                                {"times real time", true});
  plot.series = series_of(result, [](const SweepPoint& point, Series& series) {
    series.samples.push_back(sample_at(point, point.row.realtime_factor));
  });
  plot.marks = {{"real time", 1.0}};
  return plot;
}

const char* caption_of(const std::string& plot) {
  if (plot == "fps")
    return "Figure 2 of the 2016 report on this machine, with OpenCL beside OpenMP. Above the dashed line the median "
           "frame takes less time than it simulates.";
  if (plot == "speedup")
    return "Figure 3 of the 2016 report on this machine: median frame time of omp with one thread over that of the "
           "run. "
           "N threads could reach N if all work were shared out evenly.";
  if (plot == "frame_time")
    return "The same medians as times, with a bar up to the 95th percentile: frames differ because the machine does, "
           "and "
           "because faster water needs more sub-steps. Rings are the largest scenes that were measured within the "
           "budget.";
  return "Simulated seconds per second over all measured frames. Smaller particles need shorter sub-steps, so that the "
         "cost of a frame grows faster than their number.";
}

void add_tables(const SweepResult& result, HtmlReport& page) {
  page.heading("Tables");
  for (const auto& table : size_tables(result)) {
    page.paragraph(table.title);
    page.table(table.header, table.rows);
  }
  const auto leads = lead_table(result);
  if (!leads.rows.empty()) {
    page.paragraph("OpenCL against the fastest OpenMP run of each size; above 1, OpenCL is ahead");
    page.table(leads.header, leads.rows);
  }
  const auto points = point_table(result);
  page.paragraph(points.title);
  page.table(points.header, points.rows);
}

void add_agreement(const SweepResult& result, HtmlReport& page) {
  page.heading("Is it the same water?");
  std::vector<std::vector<std::string>> rows;
  for (const auto& size : result.sweep.sizes)
    rows.push_back({count_text(size.size, size.particles), fmt::format("{:.4g}", 1e3 * size.size.spacing_m),
                    size.size.scene_hash, size.agreement.verdict});
  page.table({"particles", "spacing mm", "scene", "verdict"}, rows, true);
}

void add_context(const SweepResult& result, HtmlReport& page) {
  const Context& c = result.context;
  page.heading("Measured on");
  std::vector<std::vector<std::string>> rows{
      {"processor", fmt::format("{}, {} cores, {} hardware threads", c.cpu, c.cores, c.threads)}};
  if (c.opencl)
    rows.push_back(
        {"OpenCL", fmt::format("{}, {}, driver {}, {}; kernels built with: {}", c.opencl->name, c.opencl->platform,
                               c.opencl->driver, c.opencl->version, c.opencl_build_options)});
  rows.push_back({"host", c.host});
  rows.push_back({"date", c.date});
  rows.push_back({"squall", fmt::format("{} ({})", c.squall_version, c.git_revision)});
  rows.push_back({"compiler", c.compiler + " " + c.flags});
  rows.push_back({"scene", fmt::format("{}, {} particles as written, hash {}", result.scene.name,
                                       count_text(result.scene.particles), result.scene.hash)});
  page.table({"what", "which"}, rows, true);
}

void add_definitions(HtmlReport& page) {
  page.heading("What the words mean");
  page.definitions(
      {{"frame time",
        "Wall clock from the call until the positions can be read and the queue is finished: delivery of the data is "
        "in "
        "every number."},
       {"frames per second", "1000 / median frame time in ms."},
       {"times real time", "Simulated seconds per second of wall clock, over all measured frames."},
       {"speed-up", "Median frame time of omp with one thread over that of the run, at the same size."},
       {"95 % interval",
        "Of the median ratio of equal frames: the runs of a size take turns frame by frame, so that each frame of one "
        "has its twin in the other, and what disturbs the machine meets both."},
       {"crossover",
        "Where the lines between measured medians cross, straight in the logarithms of both axes; OpenCL against the "
        "OpenMP run that is fastest at that size, or the one with as many threads if it was given a number of them."},
       {"largest scene",
        "The count at which the lines between measured medians meet the budget, then measured: the number reported is "
        "of "
        "a run at that size."},
       {"size", "The spacing of the particles changes, the water does not: every size is the same scene."}});
}

}  // namespace

std::vector<Plot> sweep_plots(const SweepResult& result) {
  std::vector<Plot> plots{fps_plot(result)};
  Plot speedup = speedup_plot(result);
  if (std::any_of(speedup.series.begin(), speedup.series.end(), [](const Series& s) { return !s.samples.empty(); }))
    plots.push_back(std::move(speedup));
  plots.push_back(frame_time_plot(result));
  plots.push_back(realtime_plot(result));
  return plots;
}

std::vector<std::string> sweep_findings(const SweepResult& result) {
  std::vector<std::string> findings;
  for (const auto& crossover : result.sweep.crossovers)
    findings.push_back(fmt::format("crossover: {} {}", crossover.label, crossover.verdict));
  for (const auto& entry : result.sweep.budget)
    findings.push_back(fmt::format("budget {:.4g} ms: {}: {}", *result.plan.budget_ms, entry.label, entry.verdict));
  findings.push_back("agreement: " + overall_agreement(result.sweep).verdict);
  return findings;
}

std::string sweep_html(const SweepResult& result, const std::vector<Picture>& pictures) {
  HtmlReport page("squall sweep: " + result.scene.name, result.context.cpu + ", " + result.context.date);
  page.list(sweep_findings(result));
  page.paragraph(fmt::format("Measured: {}.", measured_part(result)));
  page.list(result.sweep.notes);
  for (const auto& [name, svg] : pictures) page.figure(svg, name, caption_of(name));
  if (!result.sweep.budget.empty()) {
    page.heading(fmt::format("Largest scene within {:.4g} ms", *result.plan.budget_ms));
    const auto budget = budget_table(result);
    page.table(budget.header, budget.rows);
  }
  add_tables(result, page);
  add_agreement(result, page);
  add_context(result, page);
  add_definitions(page);
  return page.text();
}

}  // namespace squall::harness
