// The parallel counting sort against std::stable_sort, whatever the number of threads.

#include "backend_omp/counting_sort.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "core/frame_plan.h"
#include "grid.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

using Record = openmp::Record<float>;

class OmpSort : public testing::TestWithParam<std::tuple<int, int>> {};

INSTANTIATE_TEST_SUITE_P(SizesAndThreads, OmpSort,
                         testing::Combine(testing::Values(0, 1, 2, 63, 64, 65, 1000, (1 << 20) + 1),
                                          testing::Values(1, 2, 3, 7)),
                         [](const auto& info) {
                           return std::to_string(std::get<0>(info.param)) + "_on_" +
                                  std::to_string(std::get<1>(info.param));
                         });

TEST_P(OmpSort, IsTheStableSort) {
  const int count = std::get<0>(GetParam()), threads = std::get<1>(GetParam());
  const Params<float> p = to_single(make_params(empty_tank(), Pressure::wcsph));
  const std::vector<HeldGroup> held = {{0, 20}};
  std::mt19937 random(static_cast<unsigned>(count));
  std::uniform_real_distribution<float> place(-0.1f, 0.9f);
  std::vector<Record> records(static_cast<std::size_t>(count));
  std::vector<std::uint32_t> ids(records.size());
  std::iota(ids.begin(), ids.end(), 0u);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool lost = i % 97 == 5;
    records[i] = {lost ? SQUALL_LOST_COORDINATE : place(random), place(random), place(random), 0, 0, 0, 0, 0};
  }

  openmp::CountingSort<float> sort(p.cell_count, threads);
  openmp::TeamBarrier barrier(threads);
  std::vector<Record> sorted(records.size());
  std::vector<std::uint32_t> sorted_ids(ids.size());
  std::vector<int> keys(ids.size());
  std::vector<float> x(ids.size()), y(ids.size()), z(ids.size());
  const openmp::UnsortedParticles<float> from{records.data(), ids.data(), keys.data()};
#pragma omp parallel num_threads(threads)
  {
    const int thread = omp_get_thread_num();
    const openmp::Range chunk = openmp::share_of(count, thread, threads);
    sort.clear_counts(thread);
    sort.count(thread, chunk, p, held, from);
    barrier.wait(thread);
    sort.sort(barrier, thread, chunk, count, from, {sorted.data(), sorted_ids.data(), x.data(), y.data(), z.data()});
  }

  const auto key = [&](std::uint32_t id) {
    const Record& record = records[id];
    if (record.x == SQUALL_LOST_COORDINATE) return p.cell_count + 1;
    return id < 20 ? p.cell_count : cell_of(&p, record.x, record.y, record.z);
  };
  std::vector<std::uint32_t> expected = ids;
  std::stable_sort(expected.begin(), expected.end(), [&](auto a, auto b) { return key(a) < key(b); });
  ASSERT_EQ(sorted_ids, expected);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Record& record = records[expected[i]];
    ASSERT_EQ(std::tie(sorted[i].x, sorted[i].y, sorted[i].z), std::tie(record.x, record.y, record.z));
    ASSERT_EQ(std::tie(x[i], y[i], z[i]), std::tie(record.x, record.y, record.z));
  }
  for (int cell = 0; cell <= p.cell_count + 2; ++cell) {
    const auto first = std::partition_point(expected.begin(), expected.end(), [&](auto id) { return key(id) < cell; });
    ASSERT_EQ(sort.cell_start()[cell], first - expected.begin()) << "cell " << cell;
  }
}

}  // namespace
}  // namespace squall::test
