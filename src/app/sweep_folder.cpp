#include "app/sweep_folder.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "harness/report/gnuplot.h"

namespace squall::app {

namespace {

void check(const std::ofstream& file, const std::filesystem::path& path) {
  if (!file) throw InputError(path.string() + ": cannot write this file; check the folder's rights and free space");
}

}  // namespace

std::vector<std::filesystem::path> SweepFolder::own_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* name :
       {"report.html", "points.csv", "sweep.json", "fps.svg", "speedup.svg", "frame_time.svg", "realtime_factor.svg"})
    files.push_back(folder / name);
  return files;
}

SweepFolder::SweepFolder(const std::string& path) : path_(path) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) throw InputError(fmt::format("{}: cannot make this folder: {}", path, error.message()));
  for (const auto& file : own_files(path_)) std::filesystem::remove(file, error);
  points_.open(path_ / "points.csv");
  harness::write_points_header(points_);
  points_.flush();
  check(points_, path_ / "points.csv");
}

void SweepFolder::add_points(const std::vector<harness::SweepPoint>& points) {
  for (const auto& point : points) harness::write_point(points_, point);
  points_.flush();
  check(points_, path_ / "points.csv");
}

void SweepFolder::finish(const harness::SweepResult& result) {
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
  check(file, path_ / name);
}

}  // namespace squall::app
