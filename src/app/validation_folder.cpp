#include "app/validation_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "app/folder_files.h"
#include "core/errors.h"
#include "harness/report/gnuplot.h"
#include "harness/validation/report.h"

namespace squall::app {

std::vector<std::filesystem::path> ValidationFolder::own_files(const std::filesystem::path& folder) {
  return {folder / "report.html", folder / "validate.json"};
}

std::filesystem::path ValidationFolder::series_file(const std::filesystem::path& folder, const std::string& case_name,
                                                    const harness::RunPlan& plan) {
  return folder / fmt::format("{}_{}_{}.csv", case_name, to_string(plan.settings.pressure), plan.backend);
}

ValidationFolder::ValidationFolder(const std::string& path) : path_(path) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) throw InputError(fmt::format("{}: cannot make this folder: {}", path, error.message()));
  // Also where the folder is empty: what cannot be written is better known before hours of runs.
  check_writable(own_files(path_));
}

bool ValidationFolder::is_worth(const harness::CaseResult& result) const {
  const auto& runs = result.runs;
  if (std::any_of(runs.begin(), runs.end(), [](const auto& run) { return run.steps > 0; })) return true;
  auto files = own_files(path_);
  for (const auto& run : runs) files.push_back(series_file(path_, result.what.name, run.plan));
  return !any_exists(files);
}

void ValidationFolder::add(const harness::CaseResult& result, const harness::Json& so_far) {
  if (!begun_ && !is_worth(result)) {
    waiting_.push_back(result);
    return;
  }
  begin();
  write("validate.json", harness::json_text(so_far));
  write_case(result);
}

void ValidationFolder::begin() {
  if (begun_) return;
  begun_ = true;
  std::error_code error;
  for (const auto& file : own_files(path_)) std::filesystem::remove(file, error);
  for (const auto& result : waiting_) write_case(result);
  waiting_.clear();
}

void ValidationFolder::write_case(const harness::CaseResult& result) {
  for (const auto& run : result.runs) {
    std::ostringstream text;
    std::vector<double> times;
    if (const auto* column = run.series.find("x_cm_m")) times = column->time_s;
    harness::write_series(text, run.series, times);
    write(series_file("", result.what.name, run.plan).string(), text.str());
  }
  for (const auto& plot : harness::validation_plots(result)) {
    pictures_.emplace_back(plot.name, harness::draw_svg(plot));
    write(plot.name + ".svg", pictures_.back().second);
  }
}

void ValidationFolder::finish(const harness::Context& context, const std::vector<harness::CaseResult>& results,
                              const std::vector<std::string>& notes) {
  if (!waiting_.empty()) return;
  write("validate.json", harness::json_text(harness::to_json(context, results, notes)));
  write("report.html", harness::validation_html(context, results, pictures_, notes));
}

void ValidationFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream file(path_ / name);
  file << text << std::flush;
  check_written(file, path_ / name);
}

}  // namespace squall::app
