#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "backend_opencl/buffers.h"
#include "backend_opencl/completion.h"
#include "backend_opencl/errors.h"
#include "backend_opencl/launcher.h"
#include "backend_opencl/opencl_backend.h"
#include "backend_opencl/passes.h"
#include "backend_opencl/pressure_solve.h"
#include "backend_opencl/program.h"
#include "backend_opencl/readback.h"
#include "backend_opencl/shared_memory.h"
#include "backend_opencl/sort.h"
#include "chunks.h"
#include "core/precision.h"

namespace squall::opencl {

namespace {

using SteadyClock = std::chrono::steady_clock;

double milliseconds(SteadyClock::time_point begin, SteadyClock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// As the kernels read it.
template <class Scalar>
struct Record {
  Scalar x, y, z, spare_0, vx, vy, vz, spare_1;
};
static_assert(sizeof(Record<float>) == 32 && sizeof(Record<double>) == 64);

std::vector<MemoryNeed> all_needs(const Layout& layout, const WorkShape& shape) {
  auto needs = memory_needs(layout, shape);
  for (const auto& need : PositionReader::memory_needs(layout)) needs.push_back(need);
  return needs;
}

template <class Scalar>
class OpenclSolver final : public Solver {
 public:
  OpenclSolver(const Scene& scene, const Settings& settings)
      : Solver(scene, settings),
        machine_(open_machine(settings)),
        launcher_(machine_.queue, settings.profile, settings.trace) {
    translate_errors(device_name(), [&] { set_up(); });
  }

  SolverInfo info() const override {
    return {"opencl", machine_.info.name, lanes_name(), machine_.compute_units, options_, setup_ms_};
  }

 private:
  void do_load(const Particles& particles) override {
    count_ = 0;
    do_append(particles);
    settled_count_ = count_;
  }

  void do_append(const Particles& particles) override {
    translate_errors(device_name(), [&] { upload(particles); });
  }

  void do_advance(const FramePlan& plan, Delivery delivery, FrameReport& report) override {
    translate_errors(device_name(), [&] { advance_frame(plan, delivery == Delivery::positions, report); });
  }

  PositionsView do_positions() override { return reader_->view(); }

  Particles do_download() override {
    return translate_errors(device_name(), [&] { return download(); });
  }

  Fields do_fields() override {
    return translate_errors(device_name(), [&] { return read_fields(); });
  }

  const std::string& device_name() const { return machine_.info.name; }
  std::string lanes_name() const {
    const bool single = settings().precision == Precision::single_precision;
    return shape_.lanes == 1 ? "scalar" : (single ? "float" : "double") + std::to_string(shape_.lanes);
  }

  void set_up();
  void warm_up();
  void upload(const Particles& particles);
  Particles download();
  Fields read_fields();
  template <class Value>
  std::vector<Value> read(const cl::Buffer& buffer, std::size_t count);
  void advance_frame(const FramePlan& plan, bool deliver, FrameReport& report);
  void upload_table(const FramePlan& plan, FrameReport& report);
  void run_substep(int step, const Substep<double>& substep, bool deliver, FrameReport& report);
  bool is_dfsph() const { return settings().pressure == Pressure::dfsph; }
  void fill_report(FrameReport& report) const;
  void take_device_times(FrameReport& report);

  Machine machine_;
  Launcher launcher_;
  WorkShape shape_;
  Buffers buffers_;
  std::unique_ptr<Sort> sort_;
  std::optional<Passes> passes_;
  std::optional<PressureSolve> solve_;    // of dfsph
  std::optional<PositionReader> reader_;  // after the buffers: it unmaps before they go
  std::vector<Substep<Scalar>> table_;
  std::vector<ChunkSummary<Scalar>> summaries_;
  int count_ = 0;
  int settled_count_ = 0;  ///< when the last frame ended, or as loaded: without what was appended since
  int active_ = 0;         ///< in the last sub-step
  int ids_now_ = 0;        ///< which of the two id buffers is current
  double setup_ms_ = 0.0;
  std::string options_;  ///< of the kernels
};

template <class Scalar>
void OpenclSolver<Scalar>::set_up() {
  Layout layout;
  layout.params = params();
  layout.boxes = boxes();
  layout.groups = held_groups();
  layout.capacity = capacity();
  layout.drag = !scene().rains.empty();
  layout.dfsph = is_dfsph();
  layout.statistics = settings().statistics;
  layout.readback = settings().readback;
  layout.precision = settings().precision;
  layout.simd = settings().simd;
  layout.work = settings().work;
  shape_ = make_shape(machine_, layout);
  shape_.weights = shape_.weights && fits(machine_, all_needs(layout, shape_));
  check_limits(machine_, all_needs(layout, shape_));

  const auto begin = SteadyClock::now();
  options_ = build_options(scene(), settings(), machine_.rounds_correctly, shape_);
  const cl::Program program = build_program(machine_.context, machine_.device, embedded_kernels(), options_);
  const bool shared = PositionReader::wants_shared(layout.readback) && shares_host_memory(machine_, program);
  buffers_ = make_buffers(machine_, layout, shape_, shared && PositionReader::delivers_records(layout));
  sort_ = make_sort(program, buffers_, shape_);
  passes_.emplace(program, buffers_, shape_, settings().pressure);
  if (is_dfsph()) solve_.emplace(program, buffers_, shape_, scene().solver);
  reader_.emplace(machine_, program, buffers_, layout, shape_, shared);
  summaries_.resize(shape_.chunks);
  warm_up();
  setup_ms_ = milliseconds(begin, SteadyClock::now());
}

/// Runs every kernel once, in the shape it will have, on no particles: some drivers compile that late.
template <class Scalar>
void OpenclSolver<Scalar>::warm_up() {
  passes_->enqueue_release(launcher_, 0, 0, 0);
  sort_->enqueue(launcher_, 0, 0, 0);
  if (solve_) {
    solve_->warm_up(launcher_);
  } else {
    passes_->enqueue_density(launcher_, 0, false);
    passes_->enqueue_density(launcher_, 0, true);
    passes_->enqueue_forces(launcher_, 0, 0);
  }
  passes_->enqueue_summary(launcher_, 0, false);
  reader_->warm_up(launcher_);
  launcher_.queue().finish();
  launcher_.take_times();
}

template <class Scalar>
void OpenclSolver<Scalar>::upload(const Particles& particles) {
  reader_->withdraw();
  if (particles.size() == 0) return;
  std::vector<Record<Scalar>> records(particles.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Eigen::Matrix<Scalar, 3, 1> x = particles.positions[i].cast<Scalar>();
    const Eigen::Matrix<Scalar, 3, 1> v = particles.velocities[i].cast<Scalar>();
    const Scalar pressure = is_dfsph() ? static_cast<Scalar>(particles.pressures[i]) : Scalar(0);
    records[i] = {x[0], x[1], x[2], pressure, v[0], v[1], v[2], 0};
  }
  const auto before = static_cast<std::size_t>(count_);
  auto& queue = launcher_.queue();
  queue.enqueueWriteBuffer(buffers_.records, CL_TRUE, before * sizeof(Record<Scalar>),
                           records.size() * sizeof(Record<Scalar>), records.data());
  queue.enqueueWriteBuffer(buffers_.ids[ids_now_], CL_TRUE, before * sizeof(cl_uint), records.size() * sizeof(cl_uint),
                           particles.ids.data());
  count_ += static_cast<int>(records.size());
}

template <class Scalar>
Particles OpenclSolver<Scalar>::download() {
  reader_->withdraw();
  Particles particles;
  if (count_ == 0) return particles;
  const auto size = static_cast<std::size_t>(count_);
  std::vector<Record<Scalar>> records(size);
  std::vector<std::uint32_t> ids(size);
  auto& queue = launcher_.queue();
  queue.enqueueReadBuffer(buffers_.records, CL_TRUE, 0, size * sizeof(Record<Scalar>), records.data());
  queue.enqueueReadBuffer(buffers_.ids[ids_now_], CL_TRUE, 0, size * sizeof(cl_uint), ids.data());
  particles.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const Record<Scalar>& r = records[i];
    particles.add(ids[i], {r.x, r.y, r.z}, {r.vx, r.vy, r.vz}, is_dfsph() ? static_cast<double>(r.spare_0) : 0.0);
  }
  return particles;
}

template <class Scalar>
template <class Value>
std::vector<Value> OpenclSolver<Scalar>::read(const cl::Buffer& buffer, std::size_t count) {
  std::vector<Value> values(count);
  if (count > 0) launcher_.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(Value), values.data());
  return values;
}

template <class Scalar>
Fields OpenclSolver<Scalar>::read_fields() {
  reader_->withdraw();
  const auto active = static_cast<std::size_t>(active_);
  Fields fields;
  // dfsph leaves pressures with the particles; the others keep p/rho^2 or p/(2 rho) for the sub-step.
  const auto records = this->template read<Record<Scalar>>(is_dfsph() ? buffers_.records : buffers_.sorted, active);
  const auto densities = this->template read<Scalar>(buffers_.densities, active);
  if (settings().statistics) fields.neighbours = this->template read<cl_int>(buffers_.neighbours, active);
  for (std::size_t i = 0; i < active; ++i) {
    const double density = static_cast<double>(densities[i]), term = static_cast<double>(records[i].spare_0);
    fields.densities.push_back(density);
    fields.pressures.push_back(is_dfsph()                               ? term
                               : settings().pressure == Pressure::wcsph ? term * density * density
                                                                        : 2.0 * term * density);
  }
  return fields;
}

template <class Scalar>
void OpenclSolver<Scalar>::advance_frame(const FramePlan& plan, bool deliver, FrameReport& report) {
  launcher_.trace().clear();  // of the warm-up
  reader_->withdraw();
  upload_table(plan, report);
  const auto enqueued_from = SteadyClock::now();
  if (deliver) reader_->before_frame(launcher_, settled_count_);
  bool statistics = false;
  for (std::size_t step = 0; step < plan.substeps.size(); ++step) {
    run_substep(static_cast<int>(step), plan.substeps[step], deliver, report);
    statistics = settings().statistics && plan.substeps[step].statistics != 0;
  }
  launcher_.trace().end_substeps();
  passes_->enqueue_summary(launcher_, count_, statistics);
  auto& queue = launcher_.queue();
  cl::Event summary_read;
  launcher_.trace().add(&summary_read, "read summary");
  queue.enqueueReadBuffer(buffers_.summaries, CL_FALSE, 0, summaries_.size() * sizeof(ChunkSummary<Scalar>),
                          summaries_.data(), nullptr, &summary_read);
  const Completion computed(summary_read);
  if (deliver) reader_->after_frame(launcher_, count_);
  launcher_.trace().host("enqueue", enqueued_from);
  const auto waited_from = SteadyClock::now();
  queue.finish();
  launcher_.trace().finished();
  wait_for(summary_read, "computing a frame");
  report.readback_ms = reader_->finish(launcher_, computed);
  launcher_.trace().host("wait", waited_from);
  report.readback_copied_bytes = reader_->copied_bytes();
  report.readback_latency_frames = deliver ? reader_->latency_frames() : 0;
  settled_count_ = count_;
  fill_report(report);
  active_ = static_cast<int>(report.active);
  launcher_.trace().take(frame_start(), report);  // before its events go
  take_device_times(report);
}

template <class Scalar>
void OpenclSolver<Scalar>::take_device_times(FrameReport& report) {
  DeviceTimes times = launcher_.take_times();
  if (!settings().profile) return;
  report.phase_ms = std::move(times.phases);
  report.readback_copy_ms = times.readback;
  report.readback_hidden_ms = times.readback_hidden;
}

template <class Scalar>
void OpenclSolver<Scalar>::upload_table(const FramePlan& plan, FrameReport& report) {
  const auto begin = SteadyClock::now();
  table_.clear();
  for (const auto& substep : plan.substeps) table_.push_back(in_precision<Scalar>(substep));
  launcher_.queue().enqueueWriteBuffer(buffers_.substeps, CL_FALSE, 0, table_.size() * sizeof(Substep<Scalar>),
                                       table_.data(), nullptr, launcher_.event("upload"));
  report.upload_ms += milliseconds(begin, SteadyClock::now());
  launcher_.trace().host("upload", begin);
}

template <class Scalar>
void OpenclSolver<Scalar>::run_substep(int step, const Substep<double>& substep, bool deliver, FrameReport& report) {
  launcher_.trace().begin_substep();
  if (substep.released_count > 0) passes_->enqueue_release(launcher_, step, count_, ids_now_);
  sort_->enqueue(launcher_, step, count_, ids_now_);
  ids_now_ = 1 - ids_now_;
  if (solve_) {
    solve_->run(launcher_, step, count_, report);
  } else {
    passes_->enqueue_density(launcher_, step, settings().statistics && substep.statistics != 0);
    passes_->enqueue_forces(launcher_, step, count_);
  }
  if (deliver) reader_->after_substep(launcher_, count_);
}

template <class Scalar>
void OpenclSolver<Scalar>::fill_report(FrameReport& report) const {
  ChunkSummary<Scalar> all{};
  for (const auto& one : summaries_) {
    all.density_error += one.density_error;
    all.neighbours += one.neighbours;
    all.max_speed2 = std::max(all.max_speed2, one.max_speed2);
    all.max_acceleration2 = std::max(all.max_acceleration2, one.max_acceleration2);
    all.max_density = std::max(all.max_density, one.max_density);
    all.lost += one.lost;
    all.active += one.active;
    all.clamps += one.clamps;
  }
  report.active = all.active;
  report.lost = all.lost;
  report.clamps = all.clamps;
  report.max_speed = std::sqrt(static_cast<double>(all.max_speed2));
  report.max_acceleration = std::sqrt(static_cast<double>(all.max_acceleration2));
  if (!settings().statistics || all.active == 0) return;
  report.density_error_mean = std::ldexp(static_cast<double>(all.density_error), -32) / all.active;
  report.density_error_max = std::max(0.0, static_cast<double>(all.max_density) - 1.0);
  report.neighbours_mean = static_cast<double>(all.neighbours) / all.active;
}

}  // namespace

std::unique_ptr<Solver> make_solver(const Scene& scene, const Settings& settings) {
  if (settings.precision == Precision::single_precision) return std::make_unique<OpenclSolver<float>>(scene, settings);
  return std::make_unique<OpenclSolver<double>>(scene, settings);
}

}  // namespace squall::opencl
