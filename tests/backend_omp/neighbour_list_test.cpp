// Memory of neighbour lists: grows without losing what is in it, and what vectors load lies on cache lines.
#include "backend_omp/neighbour_list.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <utility>

namespace squall::test {
namespace {

using NeighbourList = openmp::NeighbourList<float>;

TEST(NeighbourLists, KeepWhatTheyHoldAsTheyGrow) {
  NeighbourList list;
  std::size_t count = 0;
  for (const std::size_t more : {0u, 1u, 2u, 63u, 64u, 65u, 1000u, 100000u}) {
    ASSERT_TRUE(list.reserve(more));
    ASSERT_TRUE(list.reserve_weights(more));
    ASSERT_GE(list.capacity, count + more);
    ASSERT_GE(list.weights.capacity, count + more);
    for (std::size_t i = 0; i < more; ++i, ++count) {
      list.data[list.used++] = static_cast<int>(count);
      list.weights.data[list.weights.used++] = static_cast<float>(count);
    }
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(list.weights.data) % 64, 0u);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(list.data[i], static_cast<int>(i));
      ASSERT_EQ(list.weights.data[i], static_cast<float>(i));
    }
  }
  const NeighbourList moved = std::move(list);
  EXPECT_EQ(moved.weights.used, count);
  EXPECT_EQ(moved.weights.data[count - 1], static_cast<float>(count - 1));
}

#ifndef __SANITIZE_ADDRESS__  // which ends the program where there is no memory
TEST(NeighbourLists, SayThatThereIsNoMemory) {
  NeighbourList list;
  ASSERT_TRUE(list.reserve_weights(3));
  list.weights.data[0] = 7;
  list.weights.used = 1;
  EXPECT_FALSE(list.reserve_weights(std::numeric_limits<std::size_t>::max() / 16));
  EXPECT_TRUE(list.out_of_memory);
  EXPECT_EQ(list.weights.data[0], 7);
  EXPECT_FALSE(list.reserve_weights(1)) << "once out of memory, a sub-step is given up";
}
#endif

}  // namespace
}  // namespace squall::test
