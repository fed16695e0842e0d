// The team of threads a frame gets is not always the one it asked for.

#include <gtest/gtest.h>
#include <omp.h>

#include <array>

#include "backend_omp/omp_backend.h"
#include "core/state_hash.h"
#include "support/scenes.h"

namespace squall::test {
namespace {

std::uint64_t hash_after_frames(int threads) {
  Scene scene = filled_tank(8);
  Settings settings;
  settings.threads = threads;
  const auto solver = openmp::make_solver(scene, settings);
  solver->load(initial_particles(scene));
  for (int frame = 0; frame < 3; ++frame) solver->advance();
  return state_hash(solver->state().particles, Precision::single_precision);
}

// Inside a parallel region a nested team has one thread; two solvers side by side do not meet.
TEST(OmpTeam, SolversRunInsideAParallelRegion) {
  const std::uint64_t expected = hash_after_frames(1);
  std::array<std::uint64_t, 2> hashes{};
#pragma omp parallel for num_threads(2)
  for (int i = 0; i < 2; ++i) hashes[static_cast<std::size_t>(i)] = hash_after_frames(3);
  EXPECT_EQ(hashes[0], expected);
  EXPECT_EQ(hashes[1], expected);
}

TEST(OmpTeam, TheRuntimeMayGiveFewerThreads) {
  const std::uint64_t expected = hash_after_frames(1);
  const int dynamic = omp_get_dynamic();
  omp_set_dynamic(1);
  EXPECT_EQ(hash_after_frames(64), expected);
  omp_set_dynamic(dynamic);
  EXPECT_EQ(hash_after_frames(64), expected);
}

TEST(OmpTeam, AnInstructionSetThatIsMissingIsTheMachinesFault) {
  Settings settings;
  settings.simd = Simd::avx512;
  if (openmp::available_simd().back() == Simd::avx512)
    EXPECT_NO_THROW(openmp::make_solver(filled_tank(2), settings));
  else
    EXPECT_THROW(openmp::make_solver(filled_tank(2), settings), DeviceError);
}

}  // namespace
}  // namespace squall::test
