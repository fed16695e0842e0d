#include "harness/row.h"

#include <algorithm>

namespace squall::harness {

namespace {

template <class Value>
std::vector<double> collect(const std::vector<FrameRecord>& frames, Value value) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const auto& frame : frames) values.push_back(value(frame.report));
  return values;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

double ratio(double numerator, double denominator) { return denominator > 0.0 ? numerator / denominator : 0.0; }

void summarise_times(const std::vector<FrameRecord>& frames, Row& row) {
  const auto frame = collect(frames, [](const auto& report) { return report.frame_ms; });
  const auto readback = collect(frames, [](const auto& report) { return report.readback_ms; });
  row.frame_ms = tail_of(frame);
  row.compute_ms = tail_of(collect(frames, [](const auto& report) { return report.compute_ms; }));
  row.readback_ms = tail_of(readback);
  row.upload_ms = tail_of(collect(frames, [](const auto& report) { return report.upload_ms; }));
  row.wall_s = sum(frame) / 1000.0;
  row.realtime_factor = ratio(row.simulated_s, row.wall_s);
  row.fps = ratio(1000.0, row.frame_ms.median);
  row.readback_share = ratio(sum(readback), sum(frame));
  const auto count = static_cast<double>(frames.size());
  row.readback_bytes_per_frame =
      ratio(sum(collect(frames, [](const auto& report) { return static_cast<double>(report.readback_bytes); })), count);
  row.readback_copied_bytes_per_frame =
      ratio(sum(collect(frames, [](const auto& report) { return static_cast<double>(report.readback_copied_bytes); })),
            count);
  for (const auto& record : frames)
    row.readback_latency_frames = std::max(row.readback_latency_frames, record.report.readback_latency_frames);
  double cpu = 0.0;
  for (const auto& record : frames) cpu += record.cpu_ms;
  row.cpu_ms_mean = ratio(cpu, count);
}

/// Means over particles and frames; each frame counts with its active particles, speeds also with its sub-steps.
void summarise_particles(const std::vector<FrameRecord>& frames, Row& row) {
  double active = 0.0, particle_steps = 0.0, pairs = 0.0, neighbours = 0.0, density = 0.0;
  for (const auto& record : frames) {
    const FrameReport& report = record.report;
    const auto count = static_cast<double>(report.active);
    active += count;
    particle_steps += count * report.substeps;
    pairs += count * report.substeps * report.neighbours_mean;
    neighbours += count * report.neighbours_mean;
    density += count * report.density_error_mean;
    row.density_error_max = std::max(row.density_error_max, report.density_error_max);
    row.density_error_worst = std::max(row.density_error_worst, report.density_error_mean);
    row.clamps += report.clamps;
  }
  const double compute_s = sum(collect(frames, [](const auto& report) { return report.compute_ms; })) / 1000.0;
  row.particle_steps_per_s = ratio(particle_steps, compute_s);
  row.pairs_per_s = ratio(pairs, compute_s);
  row.neighbours_mean = ratio(neighbours, active);
  row.density_error_mean = ratio(density, active);
}

/// What dfsph's solves took.
void summarise_iterations(const std::vector<FrameRecord>& frames, Row& row) {
  double density = 0.0, divergence = 0.0, passes = 0.0, particle_passes = 0.0, pass_ms = 0.0;
  for (const auto& record : frames) {
    const FrameReport& report = record.report;
    density += static_cast<double>(report.density_iterations);
    divergence += static_cast<double>(report.divergence_iterations);
    passes += static_cast<double>(report.light_passes);
    particle_passes += static_cast<double>(report.light_passes * report.active);
    pass_ms += report.light_passes_ms;
    row.density_iterations_max = std::max(row.density_iterations_max, report.density_iterations_max);
    row.divergence_iterations_max = std::max(row.divergence_iterations_max, report.divergence_iterations_max);
    row.unconverged += report.unconverged;
  }
  const auto steps = static_cast<double>(row.steps);
  row.iterations_mean = ratio(density + divergence, steps);
  row.density_iterations_mean = ratio(density, steps);
  row.divergence_iterations_mean = ratio(divergence, steps);
  row.light_passes_mean = ratio(passes, steps);
  if (pass_ms > 0.0 && particle_passes > 0.0) row.light_pass_ns = 1e6 * pass_ms / particle_passes;
}

}  // namespace

void add_profile(const Profile& profile, Row& row) {
  row.phase_ms = profile.phase_ms;
  row.readback_copy_ms.reset();
  row.readback_overlap.reset();
  if (profile.phase_ms.empty()) return;
  row.readback_copy_ms = profile.readback_copy_ms;
  if (profile.readback_copy_ms > 0.0) row.readback_overlap = profile.readback_hidden_ms / profile.readback_copy_ms;
}

void summarise(const std::vector<FrameRecord>& frames, double frame_duration_s, Row& row) {
  row.frames = static_cast<int>(frames.size());
  row.simulated_s = frame_duration_s * row.frames;
  for (const auto& record : frames) row.steps += record.report.substeps;
  summarise_times(frames, row);
  summarise_particles(frames, row);
  summarise_iterations(frames, row);
}

}  // namespace squall::harness
