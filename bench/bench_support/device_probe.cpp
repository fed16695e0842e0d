#include "bench_support/device_probe.h"

#include <algorithm>
#include <string>

#include "backend_opencl/errors.h"
#include "backend_opencl/kernel_arguments.h"
#include "backend_opencl/program.h"

namespace squall::bench {

namespace {

constexpr int k_chains = 8, k_runs = 5;
constexpr cl_int k_most_rounds = 1 << 28;

/// As support/probe-inl.h: eight independent chains of each kind.
constexpr const char* k_source = R"(
#pragma OPENCL FP_CONTRACT OFF
#define EIGHT(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
#define FUSED(i) Real p##i = start + (Real)(i * tiny);
#define PRODUCT(i) Real p##i = -(start + start) + (Real)(i * tiny);
#define SUM(i) Real s##i = (start - start) + (Real)(i * tiny);
#define FUSE(i) p##i = fma(p##i, p##i, p##i);
#define MULTIPLY(i) p##i = p##i * p##i;
#define ADD(i) s##i = s##i + s##i;
#define ROOT(i) p##i = sqrt(p##i + high);
#define QUOTIENT(i) p##i = high / (p##i + high);
#define COLLECT_PRODUCT(i) total += p##i;
#define COLLECT_SUM(i) total += s##i;
#define PROBE(name, START, WORK, COLLECT) \
  __kernel void name(int rounds, float tiny, __global float* sink) { \
    Real half_one = (Real)(0.5f + tiny), high = (Real)(1.7f); \
    Real start = -half_one + (Real)(tiny * (float)get_global_id(0)); \
    Real total = half_one; \
    START \
    for (int round = 0; round < rounds; ++round) { WORK } \
    COLLECT \
    STORE(total, sink + LANES * get_global_id(0)); \
  }
#if LANES == 1
typedef float Real;
#define STORE(value, to) *(to) = (value)
#elif LANES == 8
typedef float8 Real;
#define STORE(value, to) vstore8(value, 0, to)
#else
typedef float16 Real;
#define STORE(value, to) vstore16(value, 0, to)
#endif
PROBE(probe_fma, EIGHT(FUSED), EIGHT(FUSE), EIGHT(COLLECT_PRODUCT))
PROBE(probe_multiply, EIGHT(PRODUCT), EIGHT(MULTIPLY), EIGHT(COLLECT_PRODUCT))
PROBE(probe_add, EIGHT(SUM), EIGHT(ADD), EIGHT(COLLECT_SUM))
PROBE(probe_mixed, EIGHT(PRODUCT) EIGHT(SUM), EIGHT(MULTIPLY) EIGHT(ADD), EIGHT(COLLECT_PRODUCT) EIGHT(COLLECT_SUM))
PROBE(probe_square_root, EIGHT(FUSED), EIGHT(ROOT), EIGHT(COLLECT_PRODUCT))
PROBE(probe_divide, EIGHT(FUSED), EIGHT(QUOTIENT), EIGHT(COLLECT_PRODUCT))
__kernel void probe_copy(__global const float4* from, __global float4* to, int per_item, int passes, float tiny) {
  int first = get_group_id(0) * get_local_size(0) * per_item + get_local_id(0);
  int stride = get_local_size(0);
  for (int pass = 0; pass < passes; ++pass) /* the same again to us, not to the compiler */
    for (int k = 0; k < per_item; ++k) to[first + k * stride] = from[first + k * stride] + (float4)(tiny * pass);
}
)";

const char* kernel_of(Operation operation) {
  switch (operation) {
    case Operation::fma:
      return "probe_fma";
    case Operation::multiply:
      return "probe_multiply";
    case Operation::add:
      return "probe_add";
    case Operation::mixed:
      return "probe_mixed";
    case Operation::square_root:
      return "probe_square_root";
    case Operation::divide:
      return "probe_divide";
  }
  return "";
}

opencl::Machine open_profiled(Settings settings) {
  settings.profile = true;
  return opencl::open_machine(settings);
}

}  // namespace

DeviceProbe::DeviceProbe(const Settings& settings, int lanes, double seconds)
    : machine_(open_profiled(settings)), lanes_(lanes), seconds_(seconds), rounds_(k_operations.size(), 0) {
  // CPU devices run a work-item per thread at a time; GPUs want enough to hide every latency.
  const auto units = static_cast<std::size_t>(std::max(machine_.compute_units, 1));
  group_ = machine_.is_cpu ? 1 : 256;
  items_ = machine_.is_cpu ? 4 * units : 16 * group_ * units;
  opencl::translate_errors(machine_.info.name, [&] {
    std::string options = "-cl-std=CL1.2 -DLANES=" + std::to_string(lanes_);
    if (machine_.rounds_correctly) options += " -cl-fp32-correctly-rounded-divide-sqrt";
    const cl::Program program =
        opencl::build_program(machine_.context, machine_.device, {{"probe.cl", k_source}}, options);
    sink_ = cl::Buffer(machine_.context, CL_MEM_READ_WRITE, items_ * static_cast<std::size_t>(lanes_) * sizeof(float));
    for (const Operation operation : k_operations) arithmetic_.emplace_back(program, kernel_of(operation));
    copy_ = cl::Kernel(program, "probe_copy");
  });
}

Bounds DeviceProbe::measure(std::size_t working_set_bytes) {
  return opencl::translate_errors(machine_.info.name, [&] {
    Bounds bounds;
    for (const Operation operation : k_operations) bounds.rates[static_cast<std::size_t>(operation)] = rate(operation);
    bounds.bytes = bandwidth(working_set_bytes);
    return bounds;
  });
}

double DeviceProbe::time(const cl::Kernel& kernel) {
  cl::Event event;
  machine_.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items_), cl::NDRange(group_), nullptr, &event);
  machine_.queue.finish();
  const auto ran =
      event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  return 1e-9 * static_cast<double>(std::max<cl_ulong>(ran, 1));
}

double DeviceProbe::best_of(const cl::Kernel& kernel) {
  double best = time(kernel);
  for (int i = 1; i < k_runs; ++i) best = std::min(best, time(kernel));
  return best;
}

double DeviceProbe::rate(Operation operation) {
  cl::Kernel& kernel = arithmetic_[static_cast<std::size_t>(operation)];
  cl_int& rounds = rounds_[static_cast<std::size_t>(operation)];
  const auto set = [&] { opencl::set_arguments(kernel, rounds, 0.0f, sink_); };
  if (rounds == 0) {
    rounds = 100;
    set();
    time(kernel);  // some drivers compile only now
  }
  set();
  double best = best_of(kernel);
  for (; best < 0.5 * seconds_ && rounds < k_most_rounds; best = best_of(kernel)) {
    rounds *= 2;
    set();
  }
  const double per_round = k_chains * (operation == Operation::mixed ? 2 : 1) * static_cast<double>(lanes_);
  return per_round * rounds * static_cast<double>(items_) / best;
}

double DeviceProbe::bandwidth(std::size_t bytes) {
  constexpr std::size_t k_element = 4 * sizeof(float);
  const std::size_t per_item = std::max<std::size_t>(bytes / 2 / k_element / items_, 1);
  const std::size_t needed = per_item * items_ * k_element;
  if (room_ < needed) {
    from_ = cl::Buffer(machine_.context, CL_MEM_READ_WRITE, needed);
    to_ = cl::Buffer(machine_.context, CL_MEM_READ_WRITE, needed);
    machine_.queue.enqueueFillBuffer(from_, 1.0f, 0, needed);
    room_ = needed;
  }
  cl_int passes = 1;
  const auto set = [&] { opencl::set_arguments(copy_, from_, to_, static_cast<cl_int>(per_item), passes, 0.0f); };
  set();
  time(copy_);
  double best = best_of(copy_);
  for (; best < 0.5 * seconds_ && passes < k_most_rounds; best = best_of(copy_)) {
    passes *= 2;
    set();
  }
  return 2.0 * passes * static_cast<double>(needed) / best;
}

}  // namespace squall::bench
