#include "backend_opencl/buffers.h"

#include <algorithm>
#include <initializer_list>
#include <new>

#include "chunks.h"
#include "core/errors.h"
#include "core/precision.h"
#include "lists.h"
#include "solve_state.h"
#include "sort_bins.h"

namespace squall::opencl {

namespace {

constexpr std::size_t k_page = 4096;

// A buffer of no bytes is an error in OpenCL.
std::size_t at_least_one(std::size_t count) { return std::max<std::size_t>(count, 1); }

std::size_t round_up(std::size_t value, std::size_t step) { return (value + step - 1) / step * step; }

struct Request {
  cl::Buffer Buffers::*member;
  MemoryNeed need;
};

/// For the sort by chunks, and what blocks of particles need.
std::vector<Request> chunk_requests(const Layout& layout, const WorkShape& shape) {
  const std::size_t room = at_least_one(layout.capacity);
  const std::size_t keys = static_cast<std::size_t>(layout.params.cell_count) + 2;
  // A block's load may reach beyond the last particle.
  const std::size_t places = (room + static_cast<std::size_t>(shape.lanes)) * layout.scalar_bytes();
  return {
      {&Buffers::histograms, {"cell histograms", shape.chunks * keys * sizeof(cl_int)}},
      {&Buffers::totals, {"cell totals", shape.ranges * sizeof(cl_int)}},
      {&Buffers::cell_start, {"cell starts", (keys + 1) * sizeof(cl_int)}},
      {&Buffers::x, {"x of particles", places}},
      {&Buffers::y, {"y of particles", places}},
      {&Buffers::z, {"z of particles", places}},
      {&Buffers::lists,
       {"neighbour lists", room * static_cast<std::size_t>(list_entries(shape.lanes)) * sizeof(cl_int)}},
      {&Buffers::maxima, {"maxima", shape.chunks * 2 * layout.scalar_bytes()}},
  };
}

/// For the sort with a work-item per particle, and what such kernels need.
std::vector<Request> bin_requests(const Layout& layout) {
  const std::size_t room = at_least_one(layout.capacity);
  const std::size_t bins = bin_count(static_cast<std::size_t>(layout.params.cell_count), layout.capacity);
  return {
      {&Buffers::histograms, {"members of bins", bins * sizeof(cl_int)}},
      {&Buffers::totals, {"tile totals", bins / k_sort_fan * sizeof(cl_int)}},
      {&Buffers::group_totals, {"group totals", bins / k_sort_fan / k_sort_fan * sizeof(cl_int)}},
      {&Buffers::cell_start, {"cell starts", bins * sizeof(cl_int)}},
      {&Buffers::arrivals, {"arrivals", room * sizeof(cl_int)}},
      {&Buffers::members, {"bin members", room * sizeof(cl_int)}},
      {&Buffers::places, {"sorted positions", room * 4 * layout.scalar_bytes()}},
      {&Buffers::maxima, {"maxima", room * 2 * layout.scalar_bytes()}},
  };
}

/// A vector of lanes for each entry of the lists.
std::size_t weight_bytes(const Layout& layout, const WorkShape& shape) {
  const auto lanes = static_cast<std::size_t>(shape.lanes);
  const auto entries = static_cast<std::size_t>(list_entries(shape.lanes));
  return (shape.weights ? at_least_one(layout.capacity) * entries : 1) * lanes * layout.scalar_bytes();
}

/// For the solves of dfsph.
std::vector<Request> solve_requests(const Layout& layout, const WorkShape& shape) {
  std::vector<Request> all = {
      {&Buffers::solve, {"pressure solve", SQUALL_SOLVE_FIELDS * solve_stride(shape) * layout.scalar_bytes()}},
      {&Buffers::shares, {"shares of sums", share_count(shape) * sizeof(cl_long)}},
      {&Buffers::solve_state, {"state of solves", k_solve_state_bytes}},
  };
  if (shape.lanes == 1)
    all.push_back({&Buffers::errors, {"errors of particles", at_least_one(shape.capacity) * layout.scalar_bytes()}});
  else
    all.push_back({&Buffers::weights, {"weights of pairs", weight_bytes(layout, shape)}});
  return all;
}

std::vector<Request> requests(const Layout& layout, const WorkShape& shape) {
  const std::size_t room = at_least_one(layout.capacity);
  std::vector<Request> all = shape.lanes > 1 ? chunk_requests(layout, shape) : bin_requests(layout);
  const std::initializer_list<Request> common = {
      {&Buffers::records, {"particle records", round_up(room * layout.record_bytes(), k_page)}},
      {&Buffers::sorted, {"sorted particle records", room * layout.record_bytes()}},
      {&Buffers::keys, {"cells of particles", room * sizeof(cl_int)}},
      {&Buffers::densities, {"densities", room * layout.scalar_bytes()}},
      {&Buffers::isolations, {"isolations", (layout.drag ? room : 1) * layout.scalar_bytes()}},
      {&Buffers::neighbours, {"neighbour counts", layout.statistics ? room * sizeof(cl_int) : sizeof(cl_int)}},
      {&Buffers::clamps, {"clamps", sizeof(cl_int)}},
      {&Buffers::summaries,
       {"frame summaries",
        shape.chunks * (layout.is_double() ? sizeof(ChunkSummary<double>) : sizeof(ChunkSummary<float>))}},
      {&Buffers::substeps,
       {"sub-step table", k_max_substeps * (layout.is_double() ? sizeof(Substep<double>) : sizeof(Substep<float>))}},
      {&Buffers::params, {"constants", layout.is_double() ? sizeof(Params<double>) : sizeof(Params<float>), true}},
      {&Buffers::boxes,
       {"boxes", at_least_one(layout.boxes.size()) * (layout.is_double() ? sizeof(Box<double>) : sizeof(Box<float>)),
        true}},
      {&Buffers::groups, {"held blocks", at_least_one(layout.groups.size()) * sizeof(HeldGroup), true}},
  };
  all.insert(all.end(), common);
  if (layout.dfsph) {
    const auto solve = solve_requests(layout, shape);
    all.insert(all.end(), solve.begin(), solve.end());
  }
  return all;
}

template <class Value>
void upload(cl::CommandQueue& queue, const cl::Buffer& buffer, const std::vector<Value>& values) {
  if (!values.empty()) queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(Value), values.data());
}

template <class Scalar>
void upload_constants(cl::CommandQueue& queue, const Layout& layout, const Buffers& buffers) {
  std::vector<Box<Scalar>> boxes;
  for (const auto& box : layout.boxes) boxes.push_back(in_precision<Scalar>(box));
  upload(queue, buffers.params, std::vector<Params<Scalar>>{in_precision<Scalar>(layout.params)});
  upload(queue, buffers.boxes, boxes);
  upload(queue, buffers.substeps, std::vector<Substep<Scalar>>(1));
}

}  // namespace

void PageDeleter::operator()(std::byte* memory) const { ::operator delete[](memory, std::align_val_t{k_page}); }

Pages allocate_pages(std::size_t bytes) {
  return Pages(
      static_cast<std::byte*>(::operator new[](round_up(at_least_one(bytes), k_page), std::align_val_t{k_page})));
}

namespace {

/// CPU devices do not vectorise over work-items whose loops differ; GPUs do nothing else.
int choose_lanes(const Machine& machine, const Layout& layout) {
  if (layout.simd == Simd::scalar || (layout.simd == Simd::best && !machine.is_cpu)) return 1;
  const bool widest = layout.simd == Simd::best && machine.device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() >= 16;
  const int floats = widest || layout.simd == Simd::avx512 ? 16 : 8;
  return layout.is_double() ? floats / 2 : floats;
}

}  // namespace

std::size_t share_count(const WorkShape& shape) {
  constexpr std::size_t k_shares = 512;  // one work-item adds them up, and each adds up so many-th of the particles
  return shape.lanes == 1 ? round_up(k_shares, shape.sum_group) : shape.parts;
}

std::size_t solve_stride(const WorkShape& shape) { return round_up(at_least_one(shape.capacity), 16); }

WorkShape make_shape(const Machine& machine, const Layout& layout) {
  const WorkSizes& work = layout.work;
  check(work);
  const auto value = [](int asked, std::size_t otherwise) {
    return asked == 0 ? otherwise : static_cast<std::size_t>(asked);
  };
  WorkShape shape;
  shape.capacity = layout.capacity;
  shape.lanes = choose_lanes(machine, layout);
  shape.weights = layout.dfsph && shape.lanes > 1;
  shape.group = value(work.group, shape.group);
  if (const auto largest = machine.device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(); shape.group > largest)
    throw InputError("work groups of " + std::to_string(shape.group) + " are too large for " + machine.info.name +
                     ", which allows " + std::to_string(largest));
  const std::size_t units = at_least_one(static_cast<std::size_t>(machine.compute_units));
  shape.sum_group = std::min<std::size_t>(shape.group, 64);
  // A few shares of the rows for each processor, to even out what a share costs.
  shape.parts = value(work.parts, 4) * units;
  shape.particles = round_up(at_least_one(layout.capacity), shape.group);
  shape.chunks = value(work.chunks, 1) * units;
  shape.ranges = units;
  if (machine.is_cpu) return shape;
  constexpr std::size_t k_most_chunks = 2048;
  shape.chunk_group = 32;
  shape.chunks = work.chunks > 0 ? round_up(shape.chunks, 32) : round_up(layout.capacity / 64, 32);
  shape.chunks = std::clamp(shape.chunks, std::size_t{32}, k_most_chunks);
  if (shape.lanes == 1) return shape;
  // Many chunks for many processors, as long as their histograms stay small beside the device's memory.
  constexpr std::size_t k_histogram_bytes = std::size_t{256} << 20;
  const std::size_t keys = static_cast<std::size_t>(layout.params.cell_count) + 2;
  shape.chunks = std::clamp(k_histogram_bytes / (keys * sizeof(cl_int)) / 32 * 32, std::size_t{32}, shape.chunks);
  shape.ranges = 512;
  return shape;
}

std::vector<MemoryNeed> memory_needs(const Layout& layout, const WorkShape& shape) {
  std::vector<MemoryNeed> needs;
  for (const auto& request : requests(layout, shape)) needs.push_back(request.need);
  for (int turn = 0; turn < 2; ++turn)
    needs.push_back({"particle ids", at_least_one(layout.capacity) * sizeof(cl_uint)});
  return needs;
}

Buffers make_buffers(Machine& machine, const Layout& layout, const WorkShape& shape, bool share_records) {
  Buffers buffers;
  for (const auto& [member, need] : requests(layout, shape)) {
    const bool shared = share_records && member == &Buffers::records;
    if (shared) buffers.record_pages = allocate_pages(need.bytes);
    const cl_mem_flags flags = shared ? CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR : CL_MEM_READ_WRITE;
    buffers.*member = cl::Buffer(machine.context, flags, need.bytes, shared ? buffers.record_pages.get() : nullptr);
  }
  for (auto& ids : buffers.ids)
    ids = cl::Buffer(machine.context, CL_MEM_READ_WRITE, at_least_one(layout.capacity) * sizeof(cl_uint));
  if (layout.is_double())
    upload_constants<double>(machine.queue, layout, buffers);
  else
    upload_constants<float>(machine.queue, layout, buffers);
  upload(machine.queue, buffers.groups, layout.groups);
  // Every sort leaves zeros for the next one (sort_bin_starts.cl).
  if (shape.lanes == 1)
    upload(machine.queue, buffers.histograms,
           std::vector<cl_int>(buffers.histograms.getInfo<CL_MEM_SIZE>() / sizeof(cl_int)));
  return buffers;
}

}  // namespace squall::opencl
