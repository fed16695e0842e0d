#include "harness/validation/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/report/html_report.h"

namespace squall::harness {

namespace {

constexpr std::size_t k_most_samples = 400;  ///< of a curve in a plot

std::string file_name_part(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain) name += c;
    if (!plain && !name.empty() && name.back() != '_') name += '_';
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() ? "check" : name;
}

/// How far around an expected value a measured one passes; of errors that are no such distance there is none.
std::optional<double> reach_of(const Check& check, double tolerance, double expected) {
  if (check.measure == Measure::slope || check.measure == Measure::line || check.measure == Measure::period)
    return std::nullopt;
  return tolerance * (check.relative ? std::abs(expected) : check.scale.value_or(1.0));
}

Sample expected_sample(const Check& check, double tolerance, const ComparedPoint& point) {
  Sample sample{point.time_s, point.expected, {}, {}, ""};
  const auto reach = reach_of(check, tolerance, point.expected);
  if (!reach) return sample;
  const bool up = check.measure != Measure::above, down = check.measure != Measure::below;
  sample.low = point.expected - (down ? *reach : 0.0);
  sample.high = point.expected + (up ? *reach : 0.0);
  return sample;
}

/// Of the coarsest run, whose band is the widest. Black; a table's points stand alone.
std::vector<Series> expected_series(const CaseResult& result, std::size_t index) {
  const Check& check = result.what.checks[index];
  const CaseRun* widest = nullptr;
  for (const auto& run : result.runs) {
    const Finding& found = run.verdicts[index].finding;
    if (!found.points.empty() && (widest == nullptr || found.tolerance > widest->verdicts[index].finding.tolerance))
      widest = &run;
  }
  if (widest == nullptr || check.measure == Measure::period) return {};
  const Finding& found = widest->verdicts[index].finding;
  Series band{"expected", {}, "#000000"};
  band.points = !check.expected.points.empty();
  band.line = !band.points;
  band.dashed = true;
  band.spread = Spread::band;
  const std::size_t stride = 1 + (found.points.size() - 1) / k_most_samples;
  for (std::size_t i = 0; i < found.points.size(); i += stride)
    if (std::isfinite(found.points[i].expected))
      band.samples.push_back(expected_sample(check, found.tolerance, found.points[i]));
  // A band needs two ends.
  if (band.samples.size() == 1) band.spread = Spread::bars;
  std::vector<Series> all{band};
  Series bars{"", {}, "#000000"};
  bars.line = bars.points = false;
  bars.spread = Spread::bars;
  for (const auto& point : check.expected.points)
    if (point.low && point.high) bars.samples.push_back({point.time_s, point.value, point.low, point.high, ""});
  bars.points = true;
  if (!bars.samples.empty()) all.push_back(std::move(bars));
  return all;
}

/// With a fitted shift drawn where it is compared.
Series measured_series(const CaseRun& run, const Check& check, const Finding& found, double from_s, double to_s) {
  static const std::pair<Pressure, const char*> k_colours[] = {
      {Pressure::dfsph, "#0072b2"}, {Pressure::wcsph, "#d55e00"}, {Pressure::mueller, "#009e73"}};
  Series series{run_name(run), {}, ""};
  for (const auto& [pressure, colour] : k_colours)
    if (pressure == run.plan.settings.pressure) series.colour = colour;
  series.points = false;
  const Column* column = run.series.find(check.quantity);
  if (column == nullptr) return series;
  const std::size_t stride = 1 + column->value.size() / k_most_samples;
  for (std::size_t i = 0; i < column->value.size(); i += stride) {
    const double time = column->time_s[i] - found.shift_s.value_or(0.0);
    if (std::isfinite(column->value[i]) && time >= from_s && time <= to_s)
      series.samples.push_back({time, column->value[i], {}, {}, ""});
  }
  return series;
}

Plot check_plot(const CaseResult& result, std::size_t index) {
  const Check& check = result.what.checks[index];
  const std::string unit = unit_of(result, check.quantity);
  Plot plot;
  plot.name = file_name_part(result.what.name) + "_" + file_name_part(check.name);
  plot.title = result.what.title + ": " + check.name;
  plot.x = {"time [s]"};
  plot.y = {fmt::format("{} [{}]", check.quantity, unit)};
  plot.series = expected_series(result, index);
  double to_s = 1e30;
  if (!check.expected.points.empty()) {
    const double last = check.expected.points.back().time_s, first = check.expected.points.front().time_s;
    to_s = last + 0.1 * std::max(last - first, 1e-3);
  }
  const double half_frame = 0.5 / result.what.scene.time.frame_rate_hz;
  const double from_s = check.from_s ? *check.from_s - half_frame : -1e30;
  to_s = check.to_s ? std::min(to_s, *check.to_s + half_frame) : to_s;
  for (const auto& run : result.runs)
    plot.series.push_back(measured_series(run, check, run.verdicts[index].finding, from_s, to_s));
  return plot;
}

std::string caption_of(const CaseResult& result, std::size_t index) {
  const Check& check = result.what.checks[index];
  std::string text = fmt::format("{}: {}. Source: {}. Tolerance: {}.", check.name, measure_text(check), check.source,
                                 check.tolerance_why);
  for (const auto& run : result.runs)
    if (const auto& shift = run.verdicts[index].finding.shift_s)
      text += fmt::format(" {}: measured at t {:+.4f} s is drawn and compared at t.", run_name(run), *shift);
  return text;
}

void add_runs(const CaseResult& result, HtmlReport& page) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& run : result.runs)
    rows.push_back({run_name(run), run.solver.device, fmt::format("{}", run.particles),
                    fmt::format("{:.4g}", 1e3 * run.scene.fluid.spacing_m), short_number(run.simulated_s),
                    fmt::format("{}", run.steps), fmt::format("{:.1f}", run.iterations_mean),
                    fmt::format("{}", run.clamps), fmt::format("{:.1f}", run.wall_s)});
  page.table({"run", "device", "particles", "spacing mm", "simulated s", "sub-steps", "iterations", "clamps", "wall s"},
             rows);
}

using Pictures = std::vector<std::pair<std::string, std::string>>;

void add_case(const CaseResult& result, const Pictures& pictures, HtmlReport& page) {
  page.heading(result.what.name + ": " + result.what.title);
  page.paragraph("Source: " + result.what.source);
  const auto table = verdict_table(result);
  page.table(table.header, table.rows);
  const auto notes = remarks(result);
  if (!notes.empty()) page.list(notes);
  const auto plots = validation_plots(result);
  for (std::size_t i = 0; i < plots.size(); ++i)
    for (const auto& [name, svg] : pictures)
      if (name == plots[i].name) page.figure(svg, name, caption_of(result, i));
  add_runs(result, page);
}

}  // namespace

std::vector<Plot> validation_plots(const CaseResult& result) {
  std::vector<Plot> plots;
  for (std::size_t i = 0; i < result.what.checks.size(); ++i) {
    Plot plot = check_plot(result, i);
    const auto taken = [&](const std::string& name) {
      return std::any_of(plots.begin(), plots.end(), [&](const Plot& other) { return other.name == name; });
    };
    const std::string name = plot.name;
    for (int number = 2; taken(plot.name); ++number) plot.name = fmt::format("{}_{}", name, number);
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::string validation_html(const Context& context, const std::vector<CaseResult>& results, const Pictures& pictures,
                            const std::vector<std::string>& notes) {
  HtmlReport page("squall validate", context.cpu + ", " + context.date);
  page.paragraph(all_as_expected(results) ? "Every verdict is as expected."
                                          : "There are unexpected verdicts: see below.");
  if (!notes.empty()) page.list(notes);
  page.paragraph(
      "Dashed and grey: what is expected and the band of the tolerance, of the coarsest run. Measured values stand "
      "where "
      "measured and expected are furthest apart.");
  for (const auto& result : results) add_case(result, pictures, page);
  page.heading("Measured with");
  page.table({"what", "which"},
             {{"squall", fmt::format("{} ({})", context.squall_version, context.git_revision)},
              {"processor", context.cpu},
              {"compiler", context.compiler + " " + context.flags},
              {"date", context.date}},
             true);
  return page.text();
}

}  // namespace squall::harness
