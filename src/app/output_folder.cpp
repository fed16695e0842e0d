#include "app/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/errors.h"
#include "harness/measures.h"
#include "harness/results_csv.h"

namespace squall::app {

namespace {

bool is_frame_file(const std::string& name) {
  const std::string head = "frame_", tail = ".csv";
  constexpr std::size_t k_digits = 6;  // at least: longer runs need more
  if (name.size() < head.size() + k_digits + tail.size() || name.rfind(head, 0) != 0) return false;
  const auto end = name.end() - static_cast<std::ptrdiff_t>(tail.size());
  return std::string(end, name.end()) == tail && std::all_of(name.begin() + static_cast<std::ptrdiff_t>(head.size()),
                                                             end, [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::vector<std::filesystem::path> OutputFolder::own_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files{folder / "scene.toml", folder / "frames.csv", folder / "series.csv"};
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    if (is_frame_file(entry->path().filename().string())) files.push_back(entry->path());
  return files;
}

OutputFolder::OutputFolder(const std::string& path, const Workload& workload) : path_(path) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) throw InputError(fmt::format("{}: cannot make this folder: {}", path, error.message()));
  for (const auto& file : own_files(path_)) std::filesystem::remove(file, error);
  auto scene = open("scene.toml");
  scene << print_workload(workload) << std::flush;
  check(scene, path_ / "scene.toml");
  frames_ = open("frames.csv");
  harness::write_frames_header(frames_);
}

std::ofstream OutputFolder::open(const std::string& name) const {
  std::ofstream file(path_ / name);
  check(file, path_ / name);
  return file;
}

void OutputFolder::check(const std::ofstream& file, const std::filesystem::path& path) {
  if (!file) throw InputError(path.string() + ": cannot write this file; check the folder's rights and free space");
}

void OutputFolder::after_frame(const harness::Run& run, int save_every) {
  if (run.frames().empty()) return;
  const auto& frame = run.frames().back();
  add_frame(run.plan().label, frame);
  if (!series_.is_open()) {
    series_ = open("series.csv");
    harness::write_series_header(series_);
  }
  harness::write_observation(series_, harness::observe(run.scene(), run.state().particles, frame.time_s));
  if (save_every > 0 && run.frames().size() % static_cast<std::size_t>(save_every) == 0) save_particles(run);
}

void OutputFolder::add_frame(const std::string& label, const harness::FrameRecord& frame) {
  harness::write_frame(frames_, label, frame);
}

void OutputFolder::save_particles(const harness::Run& run) const {
  const std::string name = fmt::format("frame_{:06}.csv", run.frames().back().report.frame);
  auto file = open(name);
  harness::write_particles(file, run.scene(), run.state());
  file.flush();
  check(file, path_ / name);
}

void OutputFolder::finish() {
  frames_.flush();
  check(frames_, path_ / "frames.csv");
  if (!series_.is_open()) return;
  series_.flush();
  check(series_, path_ / "series.csv");
}

}  // namespace squall::app
