#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <type_traits>

#include "backend_omp/counting_sort.h"
#include "backend_omp/machine.h"
#include "backend_omp/omp_backend.h"
#include "backend_omp/particle_arrays.h"
#include "backend_omp/passes.h"
#include "backend_omp/phase_clock.h"
#include "backend_omp/pressure_solve.h"
#include "backend_omp/row_split.h"
#include "backend_omp/team_array.h"
#include "core/precision.h"

namespace squall::openmp {

namespace {

constexpr std::size_t k_particles_per_thread = 256;  ///< fewer are done before another thread has woken up

template <class Scalar>
class OmpSolver final : public Solver {
 public:
  OmpSolver(const Scene& scene, const Settings& settings)
      : Solver(scene, settings),
        threads_(choose_threads(settings.threads)),
        simd_(choose_simd(settings.simd)),
        passes_(passes_for<Scalar>(simd_)),
        p_(in_precision<Scalar>(params())),
        terms_{settings.pressure, scene.fluid.viscosity_m2_s.has_value(), !scene.rains.empty(),
               scene.solver.xsph > 0.0},
        barrier_(threads_),
        sort_(p_.cell_count, threads_),
        lists_(static_cast<std::size_t>(threads_)),
        solve_(passes_, scene.solver, threads_),
        particles_(terms_, settings.statistics, threads_) {
    for (const auto& box : boxes()) boxes_.push_back(in_precision<Scalar>(box));
    if (terms_.pressure == Pressure::dfsph) solve_.resize(k_padding, threads_);
  }

  SolverInfo info() const override {
    return {"omp", processor_name(), to_string(simd_), largest_team_ > 0 ? largest_team_ : threads_, "", 0.0};
  }

 private:
  void do_load(const Particles& particles) override {
    particles_.count = 0;
    lost_ = 0;
    do_append(particles);
  }

  void do_append(const Particles& particles) override {
    lost_ += particles_.append(particles);
    if (terms_.pressure == Pressure::dfsph) solve_.resize(particles_.count + k_padding, threads_);
  }

  void do_advance(const FramePlan& plan, Delivery delivery, FrameReport& report) override {
    std::vector<Substep<Scalar>> substeps;
    for (const auto& substep : plan.substeps) substeps.push_back(in_precision<Scalar>(substep));
    results_.assign(static_cast<std::size_t>(threads_), {});
    PhaseClock clock(settings(), frame_start(), substeps.size(), report);
    // More threads than the work is worth would only wait for each other. The bits do not depend on how many there are.
    const auto worth = static_cast<int>(std::min<std::size_t>(particles_.count / k_particles_per_thread, 1024));
#pragma omp parallel num_threads(std::clamp(worth, 1, threads_))
    {
      // OMP_DYNAMIC, OMP_THREAD_LIMIT or a caller that is itself parallel may have given fewer.
#pragma omp single
      barrier_.resize(omp_get_num_threads());
      const int thread = omp_get_thread_num();
      barrier_.enter(thread);
      const std::size_t done = advance_thread(thread, substeps, clock, report);
#pragma omp single
      particles_.ids_now = (particles_.ids_now + done) % 2;
    }
    largest_team_ = std::max(largest_team_, barrier_.threads());
    if (!k_delivers_in_place && delivery == Delivery::positions) round_positions(report);
    fill_report(report);
  }

  /// A frame as one thread of the team sees it. Returns how many sub-steps were done: all of them, unless memory ran
  /// out.
  std::size_t advance_thread(int thread, const std::vector<Substep<Scalar>>& substeps, PhaseClock& clock,
                             FrameReport& report) {
    const auto count = static_cast<int>(particles_.count);
    Range chunk = share_of(count, thread, barrier_.threads());
    for (std::size_t s = 0; s < substeps.size(); ++s) {
      const auto& ids = particles_.ids[(particles_.ids_now + s) % 2];
      auto& sorted_ids = particles_.ids[(particles_.ids_now + s + 1) % 2];
      if (substeps[s].released_count > 0) release(thread, substeps[s], ids);
      const UnsortedParticles<Scalar> from{particles_.state.data(), ids.data(), particles_.keys.data()};
      if (s == 0) {
        sort_.clear_counts(thread);
        sort_.count(thread, chunk, p_, held_in(substeps[s]), from);
        barrier_.wait(thread);
      }
      sort_.sort(
          barrier_, thread, chunk, count, from,
          {particles_.sorted.data(), sorted_ids.data(), particles_.x.data(), particles_.y.data(), particles_.z.data()});
      if (thread == 0) clock.finish("sort");
      const Range rows = split_rows(sort_.cell_start(), p_, passes_.lanes, thread, barrier_.threads());
      if (!find_pressures(thread, substeps[s], rows, clock, report)) return s;
      chunk = move_particles(thread, substeps[s], rows);
      // What is held or lost stays as it is, but may be held no longer. Its keys are counted after those of the rows.
      if (thread == barrier_.threads() - 1 && s + 1 < substeps.size())
        sort_.count(thread, {sort_.cell_start()[p_.cell_count], count}, p_, held_in(substeps[s + 1]),
                    {particles_.state.data(), sorted_ids.data(), particles_.keys.data()});
      barrier_.wait(thread);
      if (thread == 0) {
        clock.finish(terms_.pressure == Pressure::dfsph ? "drift" : "forces");
        clock.finish_substep();
      }
    }
    return substeps.size();
  }

  std::span<const HeldGroup> held_in(const Substep<Scalar>& substep) const {
    return {held_groups().data(), static_cast<std::size_t>(substep.held_count)};
  }

  PassContext<Scalar> context(const Substep<Scalar>& substep) {
    return {&p_,
            &substep,
            boxes_.data(),
            terms_,
            sort_.cell_start(),
            particles_.sorted.data(),
            particles_.x.data(),
            particles_.y.data(),
            particles_.z.data(),
            particles_.state.data(),
            particles_.keys.data(),
            particles_.density.data(),
            particles_.pressure.data(),
            particles_.isolation.data(),
            particles_.neighbours.data(),
            solve_.arrays()};
  }

  /// Densities and pressures; of dfsph the whole solve. False, for every thread, if one is out of memory.
  bool find_pressures(int thread, const Substep<Scalar>& substep, Range rows, PhaseClock& clock, FrameReport& report) {
    NeighbourList<Scalar>& list = lists_[static_cast<std::size_t>(thread)];
    if (terms_.pressure == Pressure::dfsph)
      return solve_.make_incompressible(barrier_, thread, context(substep), rows, list, clock, report);
    passes_.density(context(substep), rows.begin, rows.end, list);
    barrier_.wait(thread);
    if (thread == 0) clock.finish("density");
    return !any_out_of_memory();
  }

  /// Forces and all that follows. Returns the thread's chunk of the next sort: its rows, and for the last thread also
  /// what is held or lost.
  Range move_particles(int thread, const Substep<Scalar>& substep, Range rows) {
    const auto t = static_cast<std::size_t>(thread);
    const PassContext<Scalar> all = context(substep);
    int* key_counts = sort_.clear_counts(thread);
    if (substep.statistics != 0) passes_.statistics(all, rows.begin, rows.end, lists_[t], results_[t]);
    if (terms_.pressure == Pressure::dfsph)
      passes_.drift(all, rows.begin, rows.end, results_[t], key_counts);
    else
      passes_.forces(all, rows.begin, rows.end, lists_[t], results_[t], key_counts);
    const int* start = sort_.cell_start();
    Range chunk{start[rows.begin * p_.cells_x], start[rows.end * p_.cells_x]};
    if (thread == barrier_.threads() - 1) {
      chunk.end = static_cast<int>(particles_.count);
      // Held and lost particles stay as they are.
      particles_.keep_from(static_cast<std::size_t>(start[p_.cell_count]));
    }
    return chunk;
  }

  /// Particles freed now start with half a kick, like everything at the start: the other half is taken back.
  void release(int thread, const Substep<Scalar>& substep, const TeamArray<std::uint32_t>& ids) {
    const Scalar half = substep.previous_dt * p_.one_half;
    const Range share = share_of(static_cast<int>(particles_.count), thread, barrier_.threads());
    for (int g = substep.held_count; g < substep.held_count + substep.released_count; ++g) {
      const HeldGroup& group = held_groups()[static_cast<std::size_t>(g)];
      for (auto i = static_cast<std::size_t>(share.begin); i < static_cast<std::size_t>(share.end); ++i) {
        if (ids[i] < group.first_id || ids[i] >= group.end_id) continue;
        Record<Scalar>& r = particles_.state[i];
        r.vx = nfma(half, substep.acceleration_x, r.vx);
        r.vy = nfma(half, substep.acceleration_y, r.vy);
        r.vz = nfma(half, substep.acceleration_z, r.vz);
      }
    }
    barrier_.wait(thread);
  }

  bool any_out_of_memory() const {
    return std::any_of(lists_.begin(), lists_.end(),
                       [](const NeighbourList<Scalar>& list) { return list.out_of_memory; });
  }

  void fill_report(FrameReport& report) {
    if (any_out_of_memory())
      throw DeviceError("out of memory for neighbour lists; use fewer particles or a smaller support_ratio");
    PassResult<Scalar> total;
    for (const auto& result : results_) {
      total.max_speed2 = std::max(total.max_speed2, result.max_speed2);
      total.max_acceleration2 = std::max(total.max_acceleration2, result.max_acceleration2);
      total.density_error_max = std::max(total.density_error_max, result.density_error_max);
      total.density_error_sum += result.density_error_sum;
      total.neighbours += result.neighbours;
      total.clamps += result.clamps;
      lost_ += result.lost;
    }
    const int* start = sort_.cell_start();
    const int active = start[p_.cell_count];
    report.active = active;
    report.lost = lost_;
    report.clamps = total.clamps;
    report.max_speed = std::sqrt(static_cast<double>(total.max_speed2));
    report.max_acceleration = std::sqrt(static_cast<double>(total.max_acceleration2));
    report.density_error_max = static_cast<double>(total.density_error_max);
    report.density_error_mean = active > 0 ? total.density_error_sum / active : 0.0;
    report.neighbours_mean = active > 0 ? static_cast<double>(total.neighbours) / active : 0.0;
  }

  /// Positions are delivered in single precision: where they lie, or as round_positions() left them.
  PositionsView do_positions() override {
    if constexpr (k_delivers_in_place)
      return {particles_.state.data(), PositionFormat::float32, sizeof(Record<Scalar>), particles_.count};
    else
      return {rounded_.data(), PositionFormat::float32, sizeof(Position), particles_.count};
  }

  void round_positions(FrameReport& report) {
    const auto start = std::chrono::steady_clock::now();
    rounded_.resize(particles_.count, {}, threads_);
    const auto count = static_cast<std::int64_t>(particles_.count);
#pragma omp parallel for schedule(static) num_threads(barrier_.threads())
    for (std::int64_t i = 0; i < count; ++i) {
      const Record<Scalar>& r = particles_.state[static_cast<std::size_t>(i)];
      rounded_[static_cast<std::size_t>(i)] = {static_cast<float>(r.x), static_cast<float>(r.y),
                                               static_cast<float>(r.z)};
    }
    report.readback_copied_bytes = particles_.count * sizeof(Position);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    report.readback_ms = taken.count();
  }

  Particles do_download() override { return particles_.download(); }

  Fields do_fields() override { return particles_.fields(static_cast<std::size_t>(sort_.cell_start()[p_.cell_count])); }

  static constexpr bool k_delivers_in_place = std::is_same_v<Scalar, float>;
  struct Position {
    float x, y, z;
  };

  int threads_;           ///< asked for
  int largest_team_ = 0;  ///< used so far
  Simd simd_;
  const Passes<Scalar>& passes_;
  Params<Scalar> p_;
  PassTerms terms_;
  std::vector<Box<Scalar>> boxes_;
  TeamBarrier barrier_;
  CountingSort<Scalar> sort_;
  std::vector<NeighbourList<Scalar>> lists_;  ///< per thread
  PressureSolve<Scalar> solve_;               ///< of dfsph
  std::vector<PassResult<Scalar>> results_;   ///< per thread
  ParticleArrays<Scalar> particles_;
  std::int64_t lost_ = 0;
  TeamArray<Position> rounded_;  ///< what is delivered of particles_.state, if that is in double precision
};

}  // namespace

std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings) {
  if (settings.precision == Precision::single_precision) return std::make_unique<OmpSolver<float>>(scene, settings);
  return std::make_unique<OmpSolver<double>>(scene, settings);
}

}  // namespace squall::openmp
