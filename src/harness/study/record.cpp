#include "harness/study/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "core/state_hash.h"
#include "harness/run.h"
#include "harness/study/observables.h"
#include "harness/validation/observer.h"

namespace squall::harness {

namespace {

constexpr std::size_t k_tracked = 128;    ///< particles, evenly over the ids of the start
constexpr double k_jitter_dx = 1e-6;      ///< largest shift of a coordinate
constexpr double k_track_unit_dx = 1e-9;  ///< a thousandth of it

/// A well-mixed number in [-1, 1] from a counter (splitmix64's finalizer).
double mixed(std::uint64_t counter) {
  std::uint64_t z = (counter + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

/// Ids of the particles whose places are kept.
std::vector<std::uint32_t> tracked_ids(std::size_t start_count) {
  std::vector<std::uint32_t> ids;
  const std::size_t count = std::min(start_count, k_tracked);
  for (std::size_t k = 0; k < count; ++k) ids.push_back(static_cast<std::uint32_t>(k * start_count / count));
  return ids;
}

/// Follows a run and keeps what a record holds of it.
class Recorder {
 public:
  Recorder(const StudyRun& run, const Run& started)
      : run_(run),
        observer_(run.scene, run.plan.settings.pressure, 1),
        tracked_(tracked_ids(started.state().particles.size())) {
    observer_.add(started.state(), nullptr);
  }

  void add(const Run& run) {
    const auto& frames = run.frames();
    if (frames.empty() || frames.size() % static_cast<std::size_t>(run_.every) != 0) return;
    observer_.add(run.state(), &frames.back().report);
    time_s_.push_back(static_cast<double>(run.state().clock.frame) / run_.scene.time.frame_rate_hz);
    tracks_.push_back(places(run.state().particles));
    energy_in_.push_back(run.energy_in());
  }

  void fill(Record& record) const {
    record.time_s = time_s_;
    const double frame_s = run_.every / run_.scene.time.frame_rate_hz;
    record.values = sample_observables(run_.scene, observer_.series(), time_s_, frame_s);
    record.tracks = tracks_;
    const auto& energy = record.values.at("energy_j");
    for (std::size_t i = 0; i < energy.size(); ++i)
      record.energy_gain = std::max(record.energy_gain, (energy[i] - energy_in_[i]) / record.scales.at("energy_j"));
  }

 private:
  std::vector<std::int64_t> places(const Particles& particles) const {
    std::vector<std::int64_t> result(3 * tracked_.size(), 0);
    const double unit = k_track_unit_dx * run_.scene.fluid.spacing_m;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const auto found = std::lower_bound(tracked_.begin(), tracked_.end(), particles.ids[i]);
      if (found == tracked_.end() || *found != particles.ids[i] || !particles.positions[i].allFinite()) continue;
      const auto place = static_cast<std::size_t>(found - tracked_.begin());
      for (int axis = 0; axis < 3; ++axis)
        result[3 * place + static_cast<std::size_t>(axis)] =
            std::llrint(std::clamp(particles.positions[i][axis] / unit, -9e15, 9e15));
    }
    return result;
  }

  const StudyRun& run_;
  Observer observer_;
  std::vector<std::uint32_t> tracked_;
  std::vector<double> time_s_, energy_in_;
  std::vector<std::vector<std::int64_t>> tracks_;
};

void fill_from_row(const Run& run, Record& record) {
  const Row row = run.row();
  record.error = row.error;
  record.device_failed = row.device_failed;
  record.device = row.solver.device;
  record.simd = row.solver.simd;
  record.threads = row.solver.threads;
  record.state_hash = hash_text(row.state_hash);
  record.frames = row.frames;
  record.particles = row.particles;
  record.steps = row.steps;
  record.simulated_s = row.simulated_s;
  record.wall_s = row.wall_s;
  record.frame_ms_median = row.frame_ms.median;
  record.frame_ms_p95 = row.frame_ms.p95;
  record.iterations_mean = row.iterations_mean;
  record.density_error_max = row.density_error_max;
  for (const auto& frame : run.frames()) {
    record.most_substeps = std::max(record.most_substeps, frame.report.substeps);
    const double dt = frame.report.dt_s;
    if (dt > 0.0) record.smallest_dt_s = record.smallest_dt_s > 0.0 ? std::min(record.smallest_dt_s, dt) : dt;
  }
}

}  // namespace

std::string key_of(const StudyRun& run, const Context& context) {
  const Settings& settings = run.plan.settings;
  return fmt::format(
      "scene {} {} {} {} device '{}' threads {} simd {} {} frames {} every {} seed {} jitter {} repeat {} "
      "on '{}' squall {} {}",
      scene_hash(run.scene), to_string(settings.pressure), run.plan.backend, to_string(settings.precision),
      settings.device, settings.threads, to_string(settings.simd), to_string(settings.readback), run.plan.frames,
      run.every, settings.seed, run.jitter, run.repeat, context.cpu, context.squall_version, context.git_revision);
}

Particles jittered(Particles particles, double spacing_m, int number) {
  std::uint64_t counter = static_cast<std::uint64_t>(number) << 40;
  for (auto& position : particles.positions)
    for (int axis = 0; axis < 3; ++axis) position[axis] += k_jitter_dx * spacing_m * mixed(counter++);
  return particles;
}

std::optional<Record> record_run(const StudyRun& what, const std::string& key, const StudySolverFactory& make,
                                 const StudyRunProgress& progress) {
  auto solver = make(what.plan, what.scene);
  if (what.jitter > 0) solver->load(jittered(initial_particles(what.scene), what.scene.fluid.spacing_m, what.jitter));
  Run run(std::move(solver), what.plan);
  Record record;
  record.key = key;
  record.scales = observable_scales(what.scene);
  Recorder recorder(what, run);
  const bool with_series = what.repeat == 0;
  while (!run.done()) {
    const std::size_t before = run.frames().size();
    run.step();
    if (run.error().empty() && with_series && run.frames().size() > before) recorder.add(run);
    const double share = static_cast<double>(run.steps_done()) / run.steps_planned();
    if (progress && !progress(share) && !run.done()) return std::nullopt;
  }
  fill_from_row(run, record);
  if (with_series) recorder.fill(record);
  return record;
}

}  // namespace squall::harness
