#include "app/sweep_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/folder_files.h"
#include "core/errors.h"
#include "harness/report/gnuplot.h"

namespace squall::app {

std::vector<std::filesystem::path> SweepFolder::own_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* name :
       {"report.html", "points.csv", "sweep.json", "fps.svg", "speedup.svg", "frame_time.svg", "realtime_factor.svg"})
    files.push_back(folder / name);
  return files;
}

SweepFolder::SweepFolder(const std::string& path, std::string begun) : path_(path), begun_json_(std::move(begun)) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) throw InputError(fmt::format("{}: cannot make this folder: {}", path, error.message()));
  if (any_exists(own_files(path_)))
    check_writable({path_ / "points.csv", path_ / "sweep.json", path_ / "report.html"});
  else
    begin();
}

void SweepFolder::begin() {
  begun_ = true;
  std::error_code error;
  for (const auto& file : own_files(path_)) std::filesystem::remove(file, error);
  points_.open(path_ / "points.csv");
  harness::write_points_header(points_);
  points_.flush();
  check_written(points_, path_ / "points.csv");
}

void SweepFolder::add_points(const std::vector<harness::SweepPoint>& points) {
  waiting_.insert(waiting_.end(), points.begin(), points.end());
  const bool any_frame =
      std::any_of(points.begin(), points.end(), [](const auto& point) { return point.row.frames > 0; });
  if (!begun_ && !any_frame) return;
  if (!begun_) begin();
  if (any_frame && !begun_json_.empty()) write("sweep.json", std::exchange(begun_json_, ""));
  for (const auto& point : waiting_) harness::write_point(points_, point);
  waiting_.clear();
  points_.flush();
  check_written(points_, path_ / "points.csv");
}

void SweepFolder::finish(const harness::SweepResult& result) {
  if (!begun_) return;
  write("sweep.json", harness::json_text(harness::to_json(result)));
  std::vector<harness::Picture> pictures;
  for (const auto& plot : harness::sweep_plots(result)) {
    pictures.emplace_back(plot.name, harness::draw_svg(plot));
    write(plot.name + ".svg", pictures.back().second);
  }
  write("report.html", harness::sweep_html(result, pictures));
}

void SweepFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream file(path_ / name);
  file << text << std::flush;
  check_written(file, path_ / name);
}

}  // namespace squall::app
