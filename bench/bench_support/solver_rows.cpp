#include "bench_support/solver_rows.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "backends.h"
#include "core/errors.h"
#include "core/state_hash.h"
#include "harness/measures.h"

namespace squall::bench {

namespace {

constexpr int k_sampled_blocks = 4000;
/// Threads of the probes and of OpenMP spin for a while before they sleep.
constexpr std::chrono::milliseconds k_settle_time{10};

/// Why the end of a frame is wrong; empty if it is not.
std::string problem_of(Solver& solver, const FrameReport& report, const Case& of, const Variant& variant) {
  const State state = solver.state();
  if (!harness::is_finite(state.particles)) return "a position or velocity is not finite";
  if (report.lost > 0) return std::to_string(report.lost) + " particles are lost";
  if (report.time_step_limited) return "the sub-steps were too long";
  if (report.active != of.active) return "active particles are missing";
  if (variant.strict && state_hash(state.particles, Precision::single_precision) != of.end_hash)
    return "the state is not, bit for bit, what the other rows end in";
  return "";
}

LeastTime least_time_of_stages(Stage stage, const WorkOf& of, const Bounds& bounds) {
  if (stage != Stage::step) {
    const Work work = work_of(stage, of);
    return least_time(work.operations, work.bytes, bounds);
  }
  LeastTime sum;
  double longest = 0.0;
  for (const Stage part : k_stages) {
    const LeastTime least = least_time_of_stages(part, of, bounds);
    sum.seconds += least.seconds;
    if (least.seconds <= longest) continue;
    longest = least.seconds;
    sum.bound_by = std::string(to_string(part)) + " " + least.bound_by;
  }
  return sum;
}

Work work_of_stages(Stage stage, const WorkOf& of) {
  if (stage != Stage::step) return work_of(stage, of);
  Work sum;
  for (const Stage part : k_stages) {
    const Work work = work_of(part, of);
    sum.operations += work.operations;
    sum.useful += work.useful;
    sum.bytes += work.bytes;
    sum.pairs = work.pairs;
  }
  return sum;
}

}  // namespace

void SolverRows::add_step(Pressure pressure, Size size, const Variant& variant) {
  add_row(pressure, size, variant, Stage::step);
}

void SolverRows::add_stages(Pressure pressure, Size size, const Variant& variant) {
  for (const Stage stage : k_stages) add_row(pressure, size, variant, stage);
}

void SolverRows::add_row(Pressure pressure, Size size, const Variant& variant, Stage stage) {
  const Row row{pressure, size, variant, stage};
  const auto run = [this, row](benchmark::State& state) {
    const Sample sample = take_sample(row);
    if (!sample.error.empty()) {
      failed_ = true;
      state.SkipWithError(sample.error.c_str());
      return;
    }
    const double seconds = sample.seconds[static_cast<std::size_t>(row.stage)];
    for (auto _ : state) state.SetIterationTime(seconds);
    const WorkOf& of = work_for(row);
    const Work work = work_of_stages(row.stage, of);
    const LeastTime least = least_time_of_stages(row.stage, of, sample.bounds);
    state.SetLabel("bound by " + least.bound_by);
    // Of numbers that are all zero, Google Benchmark would write a variation that is not JSON.
    const auto note = [&](const char* name, double value) {
      if (value != 0.0) state.counters[name] = value;
    };
    note("share_of_bound", least.seconds / seconds);
    note("share_useful", least_time(work.useful, 0.0, sample.bounds).seconds / seconds);
    note("particles", of.particles);
    note("neighbours_mean", of.neighbours_mean);
    note("density_error_mean", cases_.get(row.pressure, row.size).density_error_mean);
    note("sub_steps", sample.substeps);
    note("ns_per_particle", 1e9 * seconds / of.particles);
    note("particle_steps_per_s", of.particles / seconds);
    note("pairs_per_s", work.pairs / seconds);
    note("flops_per_s", work.operations.flops() / seconds);
    note("bytes_per_s", work.bytes / seconds);
    note("bound_fma_flops_per_s", 2 * sample.bounds.rate(Operation::fma));
    note("bound_bytes_per_s", sample.bounds.bytes);
    if (row.stage != Stage::step) return;
    note("readback_us_per_frame", 1e6 * sample.readback_s);
    note("readback_bytes_per_frame", sample.readback_bytes);
    note("readback_copied_bytes_per_frame", sample.copied_bytes);
  };
  benchmark::RegisterBenchmark(row.name().c_str(), run)->UseManualTime()->Iterations(1)->Unit(benchmark::kMicrosecond);
}

SolverRows::Sample SolverRows::take_sample(const Row& row) {
  if (row.stage == Stage::step) return measure(row, false);
  auto& samples = profiled_[row.means()];
  const std::size_t index = taken_[row.name()]++;
  while (samples.size() <= index) samples.push_back(measure(row, true));
  return samples[index];
}

SolverRows::Sample SolverRows::measure(const Row& row, bool profile) {
  Sample sample;
  try {
    const Case& of = cases_.get(row.pressure, row.size);
    Solver& solver = solver_for(row, profile);
    const Delivery delivery = row.variant.settings.readback == Readback::none ? Delivery::nothing : Delivery::positions;
    sample.bounds = bounds_(row.variant, working_set(work_for(row)));
    solver.restore(of.state);
    std::this_thread::sleep_for(k_settle_time);
    const FrameReport report = solver.advance(delivery);
    sample.substeps = report.substeps;
    sample.readback_s = 1e-3 * report.readback_ms;
    sample.readback_bytes = static_cast<double>(report.readback_bytes);
    sample.copied_bytes = static_cast<double>(report.readback_copied_bytes);
    for (const Stage stage : k_stages) {
      const auto phase = report.phase_ms.find(to_string(stage));
      if (profile && phase == report.phase_ms.end())
        throw DeviceError(std::string("no time for the stage ") + to_string(stage));
      if (profile) sample.seconds[static_cast<std::size_t>(stage)] = 1e-3 * phase->second / report.substeps;
    }
    sample.seconds[static_cast<std::size_t>(Stage::step)] = 1e-3 * report.frame_ms / report.substeps;
    sample.error = problem_of(solver, report, of, row.variant);
  } catch (const std::exception& error) {
    sample.error = error.what();
  }
  return sample;
}

Solver& SolverRows::solver_for(const Row& row, bool profile) {
  auto& solver = solvers_[row.means() + (profile ? "/profiled" : "")];
  if (solver) return *solver;
  const Case& of = cases_.get(row.pressure, row.size);
  Settings settings = row.variant.settings;
  settings.pressure = of.pressure;
  settings.statistics = false;
  settings.profile = profile;
  solver = make_solver(row.variant.backend, of.scene, settings);
  solver->restore(of.state);
  solver->advance();  // its memory comes in place
  return *solver;
}

const WorkOf& SolverRows::work_for(const Row& row) {
  const Case& of = cases_.get(row.pressure, row.size);
  const auto [place, is_new] = works_.try_emplace(row.means());
  WorkOf& work = place->second;
  if (!is_new) return work;
  work.pressure = of.pressure;
  work.viscous = of.scene.fluid.viscosity_m2_s.has_value();
  work.walk = row.variant.walk;
  work.threads = row.variant.threads;
  work.particles = static_cast<double>(of.active);
  work.neighbours_mean = of.neighbours_mean;
  work.cells = of.params.cell_count;
  work.slots = count_pair_slots(of.params, of.state.particles, work.walk.lanes, k_sampled_blocks);
  return work;
}

}  // namespace squall::bench
