#include "app/study_folder.h"

#include <fmt/format.h>

#include <sstream>

#include "app/earlier_results.h"
#include "core/errors.h"
#include "core/text_file.h"
#include "harness/report/gnuplot.h"

namespace squall::app {

namespace {

namespace fs = std::filesystem;

void check(const std::ofstream& file, const fs::path& path) {
  if (!file) throw InputError(path.string() + ": cannot write this file; check the folder's rights and free space");
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw InputError(fmt::format("{}: cannot make this folder: {}", path.string(), error.message()));
}

/// "wcsph, step x2" as "wcsph_step_x2".
std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
    if (plain) stem += c;
    if (!plain && !stem.empty() && stem.back() != '_') stem += '_';
  }
  return stem;
}

harness::SceneInfo scene_info(const harness::Json& json) {
  return {json.at("name"), json.at("hash"), json.at("particles")};
}

}  // namespace

std::vector<fs::path> StudyFolder::own_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const char* name : {"report.html", "study.csv", "study.json", k_runs_file, "work_precision.svg",
                           "step_error.svg", "separation.svg"})
    files.push_back(folder / name);
  return files;
}

StudyFolder::StudyFolder(const std::string& path, const harness::SceneInfo& scene) : path_(path), scene_(scene) {
  read_runs();
  refuse_other_results(path, "study", {subject_of(scene)});
  make_folder(path_);
  make_folder(path_ / "scenes");
  open_runs();
}

void StudyFolder::read_runs() {
  const fs::path file = path_ / k_runs_file;
  std::error_code error;
  if (!fs::exists(file, error)) return;
  const std::string text = read_text_file(file.string());
  std::string_view rest = text;
  std::size_t line = 0;
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    ++line;
    harness::SceneInfo studied = scene_;
    try {
      const auto json = harness::Json::parse(rest.substr(0, end));
      earlier_.push_back(harness::record_from_json(json));
      if (json.contains("study")) studied = scene_info(json.at("study"));
    } catch (const std::exception& problem) {
      throw InputError(fmt::format("{}:{}: cannot be gone on with: {}; name another --out or remove this file",
                                   file.string(), line, problem.what()));
    }
    refuse_other_study(path_.string(), subject_of(studied), subject_of(scene_));
    rest.remove_prefix(end + 1);
  }
  if (!rest.empty()) whole_runs_ = text.substr(0, text.size() - rest.size());
}

void StudyFolder::open_runs() {
  const fs::path file = path_ / k_runs_file;
  if (whole_runs_) write(k_runs_file, *whole_runs_);  // a line without its end was cut off
  runs_.open(file, std::ios::app | std::ios::binary);
  check(runs_, file);
}

void StudyFolder::keep(const harness::Record& record) {
  auto json = harness::to_json(record);
  json["study"] = {{"name", scene_.name}, {"hash", scene_.hash}, {"particles", scene_.particles}};
  runs_ << json.dump() << "\n" << std::flush;
  check(runs_, path_ / k_runs_file);
}

std::string StudyFolder::write_scene(const std::string& name, const Scene& scene, Pressure pressure) {
  Scene written = scene;
  written.solver.pressure = pressure;
  const fs::path file = fs::path("scenes") / (file_stem(name) + ".toml");
  write(file, print_scene(written));
  return (path_ / file).string();
}

void StudyFolder::finish(const harness::StudyResult& result) {
  write("study.json", harness::json_text(harness::to_json(result)));
  std::ostringstream lines;
  harness::write_study_csv(lines, result);
  write("study.csv", lines.str());
  std::vector<harness::Picture> pictures;
  for (const auto& plot : harness::study_plots(result)) {
    pictures.emplace_back(plot.name, harness::draw_svg(plot));
    write(plot.name + ".svg", pictures.back().second);
  }
  write("report.html", harness::study_html(result, pictures));
}

void StudyFolder::write(const fs::path& name, const std::string& text) const {
  std::ofstream file(path_ / name, std::ios::binary);
  file << text << std::flush;
  check(file, path_ / name);
}

}  // namespace squall::app
