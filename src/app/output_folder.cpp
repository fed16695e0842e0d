#include "app/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <sstream>
#include <utility>

#include "app/earlier_rows.h"
#include "app/folder_files.h"
#include "core/checkpoint.h"
#include "core/errors.h"
#include "harness/measures.h"
#include "harness/results_csv.h"

namespace squall::app {

namespace {

std::string gauges_header(const harness::Gauges& gauges) {
  std::ostringstream header;
  harness::write_gauges_header(header, gauges);
  return std::move(header).str();
}

std::uint64_t frame_of(const std::string& frame_file) {
  std::uint64_t frame = std::numeric_limits<std::uint64_t>::max();
  const char* digits = frame_file.c_str() + frame_file.find('_') + 1;
  std::from_chars(digits, frame_file.c_str() + frame_file.find('.'), frame);
  return frame;
}

}  // namespace

bool OutputFolder::is_frame_file(const std::string& name) {
  const std::string head = "frame_", tail = ".csv";
  constexpr std::size_t k_digits = 6;  // at least: longer runs need more
  if (name.size() < head.size() + k_digits + tail.size() || name.rfind(head, 0) != 0) return false;
  const auto end = name.end() - static_cast<std::ptrdiff_t>(tail.size());
  return std::string(end, name.end()) == tail && std::all_of(name.begin() + static_cast<std::ptrdiff_t>(head.size()),
                                                             end, [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::vector<std::filesystem::path> OutputFolder::own_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files{folder / "scene.toml", folder / "frames.csv", folder / "series.csv",
                                           folder / "gauges.csv"};
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    if (is_frame_file(entry->path().filename().string())) files.push_back(entry->path());
  return files;
}

OutputFolder::OutputFolder(const std::string& path, const Workload& workload, std::uint64_t earlier_frames)
    : path_(path),
      workload_(workload),
      earlier_frames_(earlier_frames),
      earlier_s_(static_cast<double>(earlier_frames) / workload.scene.time.frame_rate_hz) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) throw InputError(fmt::format("{}: cannot make this folder: {}", path, error.message()));
  if (earlier_frames_ > 0) {
    check_earlier_scene(workload);
    check_earlier_gauges(workload);
  }
  // A device that fails before the first frame must not cost the results of an earlier run. One that goes on keeps
  // what they share and cuts the rest at once: it would come again.
  if (earlier_frames_ == 0 && any_exists(own_files(path_)))
    check_writable({path_ / "scene.toml", path_ / "frames.csv", path_ / "series.csv"});
  else
    begin();
}

void OutputFolder::begin() {
  if (begun_) return;
  begun_ = true;
  remove_old_files();
  auto scene = open("scene.toml");
  scene << print_workload(workload_) << std::flush;
  check_written(scene, path_ / "scene.toml");
  std::ostringstream header;
  harness::write_frames_header(header);
  frames_ = open_rows("frames.csv", header.str());
  if (earlier_frames_ == 0) return;
  open_series();  // rows that come after must not outlive a run that makes none
  if (!workload_.scene.gauges.empty()) open_gauges(workload_.scene, workload_.pressure);
}

void OutputFolder::check_earlier_scene(const Workload& workload) const {
  const std::string file = (path_ / "scene.toml").string();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  const Scene earlier = load_scene(file);
  if (checkpoint_scene_text(earlier, earlier.solver.pressure.value_or(workload.pressure)) !=
      checkpoint_scene_text(workload.scene, workload.pressure))
    throw InputError(path_.string() +
                     ": holds the results of another scene, which this run does not go on from; name another --out");
}

/// Before anything is cut: rows of other gauges cannot go on, and must not stay beside rows that do.
void OutputFolder::check_earlier_gauges(const Workload& workload) const {
  const std::filesystem::path file = path_ / "gauges.csv";
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file.string() + ": cannot be gone on with: it is no file; name another --out");
  if (std::filesystem::is_empty(file, error)) return;
  std::string header;
  if (!workload.scene.gauges.empty()) header = gauges_header(harness::Gauges(workload.scene, workload.pressure));
  std::ifstream rows(file);
  std::string first;
  std::getline(rows, first);
  const bool is_whole = !rows.eof();  // else the run was killed while it wrote it
  if (!header.empty() && (is_whole ? header == first + "\n" : header.starts_with(first))) return;
  throw InputError(fmt::format("{}: its columns ({}) are not those of this scene's gauges ({}); name another --out",
                               file.string(), first,
                               header.empty() ? "it has none" : header.substr(0, header.size() - 1)));
}

void OutputFolder::remove_old_files() const {
  std::error_code error;
  for (const auto& file : own_files(path_)) {
    const std::string name = file.filename().string();
    const bool is_rows = name == "frames.csv" || name == "series.csv" || name == "gauges.csv";
    const bool is_earlier = is_frame_file(name) ? frame_of(name) < earlier_frames_ : is_rows && earlier_frames_ > 0;
    if (!is_earlier) std::filesystem::remove(file, error);
  }
}

std::ofstream OutputFolder::open_rows(const std::string& name, const std::string& header) const {
  if (earlier_frames_ == 0 || !keep_rows_until(path_ / name, header, earlier_s_)) {
    auto file = open(name);
    file << header;
    return file;
  }
  std::ofstream file(path_ / name, std::ios::app);
  check_written(file, path_ / name);
  return file;
}

void OutputFolder::open_series() {
  std::ostringstream header;
  harness::write_series_header(header);
  series_ = open_rows("series.csv", header.str());
}

void OutputFolder::open_gauges(const Scene& scene, Pressure pressure) {
  gauges_.emplace(scene, pressure);
  gauges_file_ = open_rows("gauges.csv", gauges_header(*gauges_));
}

std::ofstream OutputFolder::open(const std::string& name) const {
  std::ofstream file(path_ / name);
  check_written(file, path_ / name);
  return file;
}

void OutputFolder::after_frame(const harness::Run& run, int save_every) {
  if (run.frames().empty()) return;
  const auto& frame = run.frames().back();
  add_frame(run.plan().label, frame);
  if (!series_.is_open()) open_series();
  add_gauges(run, frame.time_s);
  harness::write_observation(series_, harness::observe(run.scene(), run.state().particles, frame.time_s));
  if (save_every > 0 && run.state().clock.frame % static_cast<std::uint64_t>(save_every) == 0) save_particles(run);
}

void OutputFolder::add_gauges(const harness::Run& run, double time_s) {
  if (run.scene().gauges.empty()) return;
  if (!gauges_) open_gauges(run.scene(), run.plan().settings.pressure);
  harness::write_gauges(gauges_file_, time_s, gauges_->read(run.state()));
}

void OutputFolder::add_frame(const std::string& label, const harness::FrameRecord& frame) {
  begin();
  harness::write_frame(frames_, label, frame);
}

void OutputFolder::save_particles(const harness::Run& run) const {
  const std::string name = fmt::format("frame_{:06}.csv", run.frames().back().report.frame);
  auto file = open(name);
  harness::write_particles(file, run.scene(), run.state());
  file.flush();
  check_written(file, path_ / name);
}

void OutputFolder::flush() {
  if (!begun_) return;
  frames_.flush();
  series_.flush();
  gauges_file_.flush();
}

void OutputFolder::finish() {
  if (!begun_) return;
  frames_.flush();
  check_written(frames_, path_ / "frames.csv");
  if (!series_.is_open()) return;
  series_.flush();
  check_written(series_, path_ / "series.csv");
  if (!gauges_file_.is_open()) return;
  gauges_file_.flush();
  check_written(gauges_file_, path_ / "gauges.csv");
}

}  // namespace squall::app
