#include <fmt/format.h>

#include "harness/report/html_report.h"
#include "harness/study/observables.h"
#include "harness/study/study_report.h"
#include "harness/study/study_tables.h"

namespace squall::harness {

namespace {

const char* caption_of(const std::string& plot) {
  if (plot == "work_precision")
    return "Every stable setting: to the left is faster, below is more accurate. Joined points differ in their step "
           "alone. Rings and the dashed line are the Pareto front: no other setting is both faster and more accurate. "
           "A setting at the noise floor is drawn on it. Unstable settings stand along the upper edge, without an "
           "error of their own.";
  if (plot == "step_error")
    return "The error that the length of the step alone makes, at the scene's own spacing. Dashed: below, nothing can "
           "be told from chance.";
  return "How fast two starts that differ by a millionth of a spacing part. A straight line is exponential growth; "
         "above 0.1 dx, a particle is no longer where it was, and only observables of the whole water can be "
         "compared.";
}

void add_table(const ResultTable& table, HtmlReport& page, bool all_left = false) {
  if (table.rows.empty()) return;
  page.paragraph(table.title);
  page.table(table.header, table.rows, all_left);
}

void add_unranked(const StudyResult& result, HtmlReport& page) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < result.findings.points.size(); ++i)
    if (const auto& point = result.findings.points[i]; point.status == PointStatus::fine && !point.reason.empty())
      rows.push_back({result.runs.points.points[i].name, point.reason});
  if (rows.empty()) return;
  page.heading("Settings without an error to rank them by");
  page.table({"setting", "why"}, rows, true);
}

void add_unstable(const StudyResult& result, HtmlReport& page) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < result.findings.points.size(); ++i)
    if (const auto& point = result.findings.points[i];
        point.status == PointStatus::unstable || point.status == PointStatus::failed)
      rows.push_back({result.runs.points.points[i].name, to_string(point.status), point.reason});
  if (rows.empty()) return;
  page.heading("Settings that do not work");
  page.table({"setting", "status", "why"}, rows, true);
}

void add_context(const StudyResult& result, HtmlReport& page) {
  const Context& c = result.context;
  page.heading("Measured on");
  page.table({"what", "which"},
             {{"processor", fmt::format("{}, {} cores, {} hardware threads", c.cpu, c.cores, c.threads)},
              {"host", c.host},
              {"date", c.date},
              {"squall", fmt::format("{} ({})", c.squall_version, c.git_revision)},
              {"compiler", c.compiler + " " + c.flags},
              {"scene", fmt::format("{}, {} particles, hash {}", result.scene.name, count_text(result.scene.particles),
                                    result.scene.hash)}},
             true);
}

void add_definitions(const StudyResult& result, HtmlReport& page) {
  page.heading("What the words mean");
  std::string combined;
  for (const auto& observable : study_observables())
    if (observable.combined) combined += (combined.empty() ? "" : ", ") + observable.name;
  const std::string yardstick =
      result.findings.yardstick ? result.runs.points.models[*result.findings.yardstick].name : "none yet";
  page.definitions(
      {{"wall s/s",
        "Seconds of wall clock per simulated second, delivery of the positions included: the sum of all "
        "frame times over the time simulated; median over the timings."},
       {"p95 ms", "95th percentile of frame time; median over the timings."},
       {"error",
        "Root mean square, over the output times after every frame, of the difference of an observable from "
        "the same one of the reference, over its scale: lengths over the depth D, energy over M g D/2, "
        "pressure over rho0 g D/2."},
       {"combined", "The root mean square of the errors of " + combined + "."},
       {"reference",
        "The same pressure solver, spacing and support ratio in double, dfsph with tolerances of 1e-7, sub-steps at "
        "most an eighth of the finest of its points."},
       {"total error", "Against the yardstick, one reference for all: " + yardstick +
                           ". What solver, spacing and support ratio change is in it. density_error_mean needs no "
                           "reference: water is not compressed."},
       {"step error",
        "Against the reference of the same solver, spacing and support ratio: what the step, the "
        "tolerance, the precision and the backend make."},
       {"noise floor",
        "Twice the standard deviation between runs whose starts differ by some 1e-6 dx. '<=': the error "
        "is below it and says nothing; such settings are not ranked among each other."},
       {"horizon",
        "The last output time at which the median particle of a perturbed start is within 0.1 dx of its "
        "unperturbed twin. Trajectories are compared there and not later."},
       {"compression", "density_error_mean: root mean square over time of the mean of max(rho/rho0 - 1, 0)."},
       {"unstable",
        "Not finite, lost particles, sub-steps too long, a mean compression above 25 %, or energy from "
        "nowhere."}});
}

}  // namespace

std::string study_html(const StudyResult& result, const std::vector<Picture>& pictures) {
  HtmlReport page("squall study: " + result.scene.name, result.context.cpu + ", " + result.context.date);
  page.list(recommendations(result));
  page.paragraph(study_headline(result) + ".");
  page.list(result.notes);
  for (const auto& [name, svg] : pictures) page.figure(svg, name, caption_of(name));
  page.heading("Tables");
  add_table(cost_table(result), page);
  add_table(error_table(result, true), page);
  add_table(error_table(result, false), page);
  add_table(noise_table(result), page);
  add_table(order_table(result), page);
  add_unstable(result, page);
  add_unranked(result, page);
  page.heading("Run them again");
  add_table(command_table(result), page, true);
  add_context(result, page);
  add_definitions(result, page);
  return page.text();
}

}  // namespace squall::harness
