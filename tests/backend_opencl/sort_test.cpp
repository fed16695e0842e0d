#include "backend_opencl/sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "backend_opencl/passes.h"
#include "backend_opencl/program.h"
#include "grid.h"

namespace squall::opencl {
namespace {

constexpr float k_edge = 0.1f;
constexpr std::uint32_t k_held_until = 40;  // ids below are held

struct Record {
  float x, y, z, spare_0, vx, vy, vz, spare_1;
  bool operator==(const Record&) const = default;
};

Params<float> small_grid() {
  Params<float> p{};
  p.cells_x = 14;
  p.cells_y = 5;
  p.cells_z = 3;
  p.cell_count = p.cells_x * p.cells_y * p.cells_z;
  p.inverse_edge_yz = 1.0f / k_edge;
  p.inverse_edge_x = 2.0f / k_edge;
  return p;
}

/// Particles all over the grid and beside it, some lost, ids in no order.
struct Input {
  std::vector<Record> records;
  std::vector<std::uint32_t> ids;
};

Input make_input(std::size_t count) {
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

int key(const Params<float>& p, const Record& record, std::uint32_t id) {
  if (is_lost(record.x)) return lost_cell(&p);
  return id < k_held_until ? held_cell(&p) : cell_of(&p, record.x, record.y, record.z);
}

template <class Value>
std::vector<Value> read(cl::CommandQueue& queue, const cl::Buffer& buffer, std::size_t count) {
  std::vector<Value> values(count);
  if (count > 0) queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(Value), values.data());
  return values;
}

class SortSizes : public testing::TestWithParam<std::size_t> {};

TEST_P(SortSizes, IsTheStableSort) {
  const std::size_t count = GetParam();
  const Input input = make_input(count);
  Machine machine = open_machine(Settings{});
  Layout layout;
  layout.params = small_grid();
  layout.groups = {{0, k_held_until}};
  layout.capacity = count;
  const WorkShape shape = make_shape(machine, layout);
  Buffers buffers = make_buffers(machine, layout, shape, false);
  const cl::Program program =
      build_program(machine.context, machine.device, embedded_kernels(),
                    build_options(Scene{}, Pressure::wcsph, machine.rounds_correctly, shape.lanes));
  Launcher launcher(machine.queue, false);
  Substep<float> substep{};
  substep.held_count = 1;
  machine.queue.enqueueWriteBuffer(buffers.substeps, CL_TRUE, 0, sizeof substep, &substep);
  if (count > 0) {
    machine.queue.enqueueWriteBuffer(buffers.records, CL_TRUE, 0, count * sizeof(Record), input.records.data());
    machine.queue.enqueueWriteBuffer(buffers.ids[1], CL_TRUE, 0, count * 4, input.ids.data());
  }

  Sort(program, buffers, shape).enqueue(launcher, 0, static_cast<int>(count), 1);
  const auto records = read<Record>(machine.queue, buffers.sorted, count);
  const auto ids = read<std::uint32_t>(machine.queue, buffers.ids[0], count);
  const auto starts =
      read<int>(machine.queue, buffers.cell_start, static_cast<std::size_t>(layout.params.cell_count) + 3);

  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key_of = [&](std::size_t i) { return key(layout.params, input.records[i], input.ids[i]); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key_of(a) < key_of(b); });
  std::vector<int> expected_starts(starts.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(ids[i], input.ids[order[i]]) << "place " << i;
    ASSERT_EQ(records[i], input.records[order[i]]) << "place " << i;
    ++expected_starts[static_cast<std::size_t>(key_of(i)) + 1];
  }
  std::partial_sum(expected_starts.begin(), expected_starts.end(), expected_starts.begin());
  EXPECT_EQ(starts, expected_starts);
}

INSTANTIATE_TEST_SUITE_P(Opencl, SortSizes, testing::Values(0, 1, 2, 63, 64, 65, 1000, (1 << 20) + 1));

}  // namespace
}  // namespace squall::opencl
