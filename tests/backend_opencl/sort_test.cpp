#include "backend_opencl/sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <ostream>
#include <random>
#include <string>
#include <tuple>

#include "backend_opencl/passes.h"
#include "backend_opencl/program.h"
#include "core/precision.h"
#include "grid.h"
#include "sort_bins.h"

namespace squall::opencl {
namespace {

constexpr float k_edge = 0.1f;
constexpr std::uint32_t k_held_until = 40;

struct Record {
  float x, y, z, spare_0, vx, vy, vz, spare_1;
  bool operator==(const Record&) const = default;
};

Params<double> small_grid() {
  Params<double> p{};
  p.cells_x = 14;
  p.cells_y = 5;
  p.cells_z = 3;
  p.cell_count = p.cells_x * p.cells_y * p.cells_z;
  p.inverse_edge_yz = 1.0f / k_edge;
  p.inverse_edge_x = 2.0f / k_edge;
  return p;
}

/// Particles, ids in no order.
struct Input {
  std::vector<Record> records;
  std::vector<std::uint32_t> ids;
  std::uint32_t held_until = k_held_until;  ///< ids below are held
};

/// All over the grid and beside it, some lost, some held.
Input everywhere(std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(count) + 1);
  std::uniform_real_distribution<float> place(-0.1f, 0.8f);
  Input input{std::vector<Record>(count), std::vector<std::uint32_t>(count)};
  std::iota(input.ids.begin(), input.ids.end(), 0u);
  std::shuffle(input.ids.begin(), input.ids.end(), random);
  for (std::size_t i = 0; i < count; ++i) {
    const bool lost = random() % 31 == 0;
    const auto tag = static_cast<float>(input.ids[i]);
    input.records[i] = {
        lost ? SQUALL_LOST_COORDINATE : place(random), place(random), place(random), 0.0f, tag, 0, 0, 0};
  }
  return input;
}

Input in_one_cell(std::size_t count) {
  Input input = everywhere(count);
  input.held_until = 0;
  for (Record& record : input.records) record.x = record.y = record.z = 0.01f;
  return input;
}

Input all_held(std::size_t count) {
  Input input = everywhere(count);
  input.held_until = static_cast<std::uint32_t>(count);
  for (Record& record : input.records) record.x = 0.1f;
  return input;
}

Input all_lost(std::size_t count) {
  Input input = everywhere(count);
  for (Record& record : input.records) record.x = SQUALL_LOST_COORDINATE;
  return input;
}

/// Held and lost ones between others, each kind in runs and alone.
Input mixed(std::size_t count) {
  Input input = everywhere(count);
  input.held_until = static_cast<std::uint32_t>(count / 2);
  for (std::size_t i = 0; i < count; ++i)
    if (i % 7 == 0 || i % 500 > 400) input.records[i].x = SQUALL_LOST_COORDINATE;
  return input;
}

int key(const Params<float>& p, const Input& input, std::size_t i) {
  const Record& record = input.records[i];
  if (is_lost(record.x)) return lost_cell(&p);
  return input.ids[i] < input.held_until ? held_cell(&p) : cell_of(&p, record.x, record.y, record.z);
}

template <class Value>
std::vector<Value> read(cl::CommandQueue& queue, const cl::Buffer& buffer, std::size_t count) {
  std::vector<Value> values(count);
  if (count > 0) queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(Value), values.data());
  return values;
}

/// The sorts, by the kernels they belong to: of GPUs, a work-item per particle; of CPU devices, one per chunk.
struct Way {
  std::string name;
  Simd simd;
  int chunks = 0;  // per compute unit
};

const Way k_particles{"particles", Simd::scalar};
const Way k_chunks{"chunks", Simd::avx2};

void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

Settings wcsph() {
  Settings settings;
  settings.pressure = Pressure::wcsph;
  return settings;
}

/// A machine with everything a sort needs.
class SortBench {
 public:
  SortBench(const Way& way, const Input& input)
      : input_(input), machine_(open_machine(Settings{})), launcher_(machine_.queue, false) {
    layout_.params = small_grid();
    layout_.groups = {{0, input.held_until}};
    layout_.capacity = input.records.size();
    layout_.simd = way.simd;
    layout_.work.chunks = way.chunks;
    shape_ = make_shape(machine_, layout_);
    buffers_ = make_buffers(machine_, layout_, shape_, false);
    const cl::Program program = build_program(machine_.context, machine_.device, embedded_kernels(),
                                              build_options(Scene{}, wcsph(), machine_.rounds_correctly, shape_));
    Substep<float> substep{};
    substep.held_count = 1;
    machine_.queue.enqueueWriteBuffer(buffers_.substeps, CL_TRUE, 0, sizeof substep, &substep);
    sort_ = make_sort(program, buffers_, shape_);
  }

  /// Uploads the input and sorts it.
  void run() {
    if (count() > 0) {
      machine_.queue.enqueueWriteBuffer(buffers_.records, CL_TRUE, 0, count() * sizeof(Record), input_.records.data());
      machine_.queue.enqueueWriteBuffer(buffers_.ids[1], CL_TRUE, 0, count() * 4, input_.ids.data());
    }
    sort_->enqueue(launcher_, 0, static_cast<int>(count()), 1);
  }

  void expect_stable_order() {
    const auto records = read<Record>(machine_.queue, buffers_.sorted, count());
    const auto ids = read<std::uint32_t>(machine_.queue, buffers_.ids[0], count());
    const auto cells = static_cast<std::size_t>(layout_.params.cell_count);
    const auto starts = read<int>(machine_.queue, buffers_.cell_start, cells + 1);
    std::vector<std::size_t> order(count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto params = in_precision<float>(layout_.params);
    const auto key_of = [&](std::size_t i) { return key(params, input_, i); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key_of(a) < key_of(b); });
    std::vector<int> expected_starts(cells + 3, 0);
    for (std::size_t i = 0; i < count(); ++i) {
      ASSERT_EQ(ids[i], input_.ids[order[i]]) << "place " << i;
      ASSERT_EQ(records[i], input_.records[order[i]]) << "place " << i;
      ++expected_starts[static_cast<std::size_t>(key_of(i)) + 1];
    }
    std::partial_sum(expected_starts.begin(), expected_starts.end(), expected_starts.begin());
    expected_starts.resize(cells + 1);  // behind the cells each sort has its own bins
    EXPECT_EQ(starts, expected_starts);
    if (shape_.lanes == 1) expect_places(records);
  }

 private:
  std::size_t count() const { return input_.records.size(); }

  void expect_places(const std::vector<Record>& records) {
    const auto places = read<std::array<float, 4>>(machine_.queue, buffers_.places, count());
    for (std::size_t i = 0; i < count(); ++i)
      ASSERT_TRUE(places[i][0] == records[i].x && places[i][1] == records[i].y && places[i][2] == records[i].z) << i;
  }

  const Input& input_;
  Machine machine_;
  Launcher launcher_;
  Layout layout_;
  WorkShape shape_;
  Buffers buffers_;
  std::unique_ptr<Sort> sort_;
};

/// Twice: a sort must leave nothing behind that the next one stumbles over.
void expect_stable(const Way& way, const Input& input) {
  SortBench bench(way, input);
  for (int turn = 0; turn < 2; ++turn) {
    SCOPED_TRACE(testing::Message() << "turn " << turn);
    bench.run();
    bench.expect_stable_order();
    if (testing::Test::HasFatalFailure()) return;
  }
}

class SortSizes : public testing::TestWithParam<std::tuple<Way, std::size_t>> {};

std::string name_of(const Way& way, std::size_t count) { return way.name + "_" + std::to_string(count); }

TEST_P(SortSizes, IsTheStableSort) { expect_stable(std::get<0>(GetParam()), everywhere(std::get<1>(GetParam()))); }

INSTANTIATE_TEST_SUITE_P(Opencl, SortSizes,
                         testing::Combine(testing::Values(k_particles, k_chunks),
                                          testing::Values(0, 1, 2, 63, 64, 65, 1000, (1 << 20) + 1)),
                         [](const auto& info) { return name_of(std::get<0>(info.param), std::get<1>(info.param)); });

TEST(SortBins, OneMoreThanAreInUseAndWholeGroups) {
  static_assert(bin_count(0, 0) == 4096 && bin_count(4095, 0) == 4096 && bin_count(4096, 0) == 8192);
  static_assert(bin_count(4093, 64) == 4096 && bin_count(4094, 64) == 8192 && bin_count(4093, 65) == 8192);
}

class SortCrowds : public testing::TestWithParam<std::tuple<Way, std::size_t>> {};

TEST_P(SortCrowds, AreSortedStably) {
  const auto [way, count] = GetParam();
  expect_stable(way, in_one_cell(count));
  expect_stable(way, all_held(count));
  expect_stable(way, all_lost(count));
  expect_stable(way, mixed(count));
}

INSTANTIATE_TEST_SUITE_P(Opencl, SortCrowds,
                         testing::Combine(testing::Values(k_particles, k_chunks, Way{"many_chunks", Simd::avx512, 64}),
                                          testing::Values(1, 63, 64, 65, 5003)),
                         [](const auto& info) { return name_of(std::get<0>(info.param), std::get<1>(info.param)); });

// Held and lost particles have no neighbours, so nobody expects their number to cost anything. They go in bins of 64;
// in one bin this many would need 2^40 comparisons, which no test would sit through.
TEST(SortOfMany, AMillionHeldOrLostOnesTakeNoLongerThanOthers) {
  constexpr std::size_t k_count = (1 << 20) + 1;
  expect_stable(k_particles, all_held(k_count));
  expect_stable(k_particles, all_lost(k_count));
}

}  // namespace
}  // namespace squall::opencl
