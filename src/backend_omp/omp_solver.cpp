#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include "backend_omp/counting_sort.h"
#include "backend_omp/omp_backend.h"
#include "backend_omp/passes.h"
#include "grid.h"

namespace squall::openmp {

namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "CPU";
}

Simd choose_simd(Simd wanted) {
  const std::vector<Simd> available = available_simd();
  if (wanted == Simd::best) return available.back();
  if (std::find(available.begin(), available.end(), wanted) == available.end())
    throw DeviceError(std::string("this machine cannot run ") + to_string(wanted) + " code; it can run up to " +
                      to_string(available.back()));
  return wanted;
}

/// Wall clock per phase, noted by one thread at its barriers; does nothing unless profiling.
class PhaseClock {
 public:
  PhaseClock(bool on, std::map<std::string, double>& phases) : on_(on), phases_(phases), last_(Now()) {}
  void finish(const char* phase) {
    if (!on_) return;
    const auto now = Now();
    phases_[phase] += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  static std::chrono::steady_clock::time_point Now() { return std::chrono::steady_clock::now(); }
  bool on_;
  std::map<std::string, double>& phases_;
  std::chrono::steady_clock::time_point last_;
};

constexpr std::size_t k_particles_per_thread = 256;  ///< fewer are done before another thread has woken up

class OmpSolver final : public Solver {
 public:
  OmpSolver(const Scene& scene, const Settings& settings)
      : Solver(scene, settings),
        threads_(settings.threads > 0 ? settings.threads : omp_get_max_threads()),
        simd_(choose_simd(settings.simd)),
        passes_(passes_for(simd_)),
        p_(to_single(params())),
        terms_{settings.pressure, scene.fluid.viscosity_m2_s.has_value(), !scene.rains.empty()},
        barrier_(threads_),
        sort_(p_.cell_count, threads_),
        lists_(static_cast<std::size_t>(threads_)) {
    if (settings.precision != Precision::single_precision)
      throw InputError("precision double is not in this version of the omp backend; use --backend reference");
    for (const auto& box : boxes()) boxes_.push_back(to_single(box));
    resize(0);
  }

  SolverInfo info() const override {
    return {"omp", processor_name(), to_string(simd_), largest_team_ > 0 ? largest_team_ : threads_, "", 0.0};
  }

 private:
  void do_load(const Particles& particles) override {
    count_ = 0;
    lost_ = 0;
    do_append(particles);
  }

  void do_append(const Particles& particles) override {
    const std::size_t first = count_;
    resize(count_ + particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Eigen::Vector3f x = particles.positions[i].cast<float>(), v = particles.velocities[i].cast<float>();
      state_[first + i] = {x.x(), x.y(), x.z(), 0.0f, v.x(), v.y(), v.z(), 0.0f};
      state_ids_[first + i] = particles.ids[i];
      lost_ += is_lost(x.x());
    }
  }

  /// Room for `count` particles and the padding behind them, which lies far away from everything.
  void resize(std::size_t count) {
    const Record far{
        SQUALL_LOST_COORDINATE, SQUALL_LOST_COORDINATE, SQUALL_LOST_COORDINATE, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    const std::size_t padded = count + k_padding;
    state_.resize(padded);
    sorted_.resize(padded);
    std::fill(sorted_.begin() + static_cast<std::ptrdiff_t>(count), sorted_.end(), far);
    state_ids_.resize(padded);
    sorted_ids_.resize(padded);
    cells_.resize(padded);
    density_.resize(padded, 1.0f);
    if (terms_.pressure == Pressure::mueller) pressure_.resize(padded, 0.0f);
    if (terms_.drag) isolation_.resize(padded, 0.0f);
    count_ = count;
  }

  void do_advance(const FramePlan& plan, Delivery, FrameReport& report) override {
    std::vector<Substep<float>> substeps;
    for (const auto& substep : plan.substeps) substeps.push_back(to_single(substep));
    results_.assign(static_cast<std::size_t>(threads_), {});
    PhaseClock clock(settings().profile, report.phase_ms);
    // More threads than the work is worth would only wait for each other. The bits do not depend on how many there are.
    const auto worth = static_cast<int>(std::min<std::size_t>(count_ / k_particles_per_thread, 1024));
#pragma omp parallel num_threads(std::clamp(worth, 1, threads_))
    {
      // OMP_DYNAMIC, OMP_THREAD_LIMIT or a caller that is itself parallel may have given fewer.
#pragma omp single
      barrier_.resize(omp_get_num_threads());
      const int thread = omp_get_thread_num();
      barrier_.enter(thread);
      for (const auto& substep : substeps) advance_substep(thread, substep, clock);
    }
    largest_team_ = std::max(largest_team_, barrier_.threads());
    fill_report(report);
  }

  void advance_substep(int thread, const Substep<float>& substep, PhaseClock& clock) {
    const auto t = static_cast<std::size_t>(thread);
    if (substep.released_count > 0) release(thread, substep);
    const std::span<const HeldGroup> held(held_groups().data(), static_cast<std::size_t>(substep.held_count));
    sort_.sort(barrier_, thread, static_cast<int>(count_), p_, held, state_.data(), state_ids_.data(), sorted_.data(),
               sorted_ids_.data(), cells_.data());
    if (thread == 0) clock.finish("sort");
    const PassContext context{
        &p_,           &substep,        boxes_.data(),    terms_,           sort_.cell_start(), sorted_.data(),
        state_.data(), density_.data(), pressure_.data(), isolation_.data()};
    const int first_row = row_split(thread), end_row = row_split(thread + 1);
    passes_.density(context, first_row, end_row, lists_[t]);
    barrier_.wait(thread);
    if (thread == 0) clock.finish("density");
    if (!any_out_of_memory()) {
      if (substep.statistics != 0) passes_.statistics(context, first_row, end_row, lists_[t], results_[t]);
      passes_.forces(context, first_row, end_row, lists_[t], results_[t]);
    }
    if (thread == barrier_.threads() - 1) copy_inactive();
    barrier_.wait(thread);
    if (thread == 0) {
      std::swap(state_ids_, sorted_ids_);
      clock.finish("forces");
    }
    barrier_.wait(thread);
  }

  /// Particles freed now start with half a kick, like everything at the start: the other half is taken back.
  void release(int thread, const Substep<float>& substep) {
    const float half = substep.previous_dt * p_.one_half;
    const auto team = static_cast<std::size_t>(barrier_.threads());
    const std::size_t begin = count_ * static_cast<std::size_t>(thread) / team;
    const std::size_t end = count_ * static_cast<std::size_t>(thread + 1) / team;
    for (int g = substep.held_count; g < substep.held_count + substep.released_count; ++g) {
      const HeldGroup& group = held_groups()[static_cast<std::size_t>(g)];
      for (std::size_t i = begin; i < end; ++i) {
        if (state_ids_[i] < group.first_id || state_ids_[i] >= group.end_id) continue;
        state_[i].vx = nfma(half, substep.acceleration_x, state_[i].vx);
        state_[i].vy = nfma(half, substep.acceleration_y, state_[i].vy);
        state_[i].vz = nfma(half, substep.acceleration_z, state_[i].vz);
      }
    }
    barrier_.wait(thread);
  }

  /// Row at which a thread's share begins: the same split in every pass, by particle count.
  int row_split(int thread) const {
    const int rows = p_.cells_y * p_.cells_z;
    if (thread == 0) return 0;
    if (thread == barrier_.threads()) return rows;
    const int* start = sort_.cell_start();
    const auto target = static_cast<int>(std::int64_t{start[p_.cell_count]} * thread / barrier_.threads());
    int low = 0, high = rows;
    while (low < high) {
      const int middle = (low + high) / 2;
      if (start[middle * p_.cells_x] < target)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }

  /// Held and lost particles stay as they are.
  void copy_inactive() {
    const auto first = static_cast<std::size_t>(sort_.cell_start()[p_.cell_count]);
    std::copy(sorted_.begin() + static_cast<std::ptrdiff_t>(first),
              sorted_.begin() + static_cast<std::ptrdiff_t>(count_),
              state_.begin() + static_cast<std::ptrdiff_t>(first));
  }

  bool any_out_of_memory() const {
    return std::any_of(lists_.begin(), lists_.end(), [](const NeighbourList& list) { return list.out_of_memory; });
  }

  void fill_report(FrameReport& report) {
    if (any_out_of_memory())
      throw DeviceError("out of memory for neighbour lists; use fewer particles or a smaller support_ratio");
    PassResult total;
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

  PositionsView do_positions() override { return {state_.data(), PositionFormat::float32, sizeof(Record), count_}; }

  Particles do_download() override {
    Particles particles;
    particles.reserve(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const Record& r = state_[i];
      particles.add(state_ids_[i], Eigen::Vector3f(r.x, r.y, r.z).cast<double>(),
                    Eigen::Vector3f(r.vx, r.vy, r.vz).cast<double>());
    }
    return particles;
  }

  int threads_;           ///< asked for
  int largest_team_ = 0;  ///< used so far
  Simd simd_;
  const Passes& passes_;
  Params<float> p_;
  PassTerms terms_;
  std::vector<Box<float>> boxes_;
  TeamBarrier barrier_;
  CountingSort sort_;
  std::vector<NeighbourList> lists_;  ///< per thread
  std::vector<PassResult> results_;   ///< per thread
  std::size_t count_ = 0;
  std::int64_t lost_ = 0;
  std::vector<Record> state_, sorted_;  ///< between sub-steps; within one, in canonical order
  std::vector<std::uint32_t> state_ids_, sorted_ids_;
  std::vector<int> cells_;
  std::vector<float> density_, pressure_, isolation_;
};

}  // namespace

std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings) {
  return std::make_unique<OmpSolver>(scene, settings);
}

std::vector<DeviceInfo> devices() {
  DeviceInfo device;
  device.backend = "omp";
  device.name = processor_name();
  device.kind = "cpu";
  device.compute_units = static_cast<int>(std::thread::hardware_concurrency());
  device.version = std::string("up to ") + to_string(available_simd().back());
  return {device};
}

}  // namespace squall::openmp
