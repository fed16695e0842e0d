#include "bench_support/work_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "grid.h"
#include "support/scenes.h"

namespace squall::bench {
namespace {

// By hand, from kernels/sph_formulas.h.
TEST(WorkModel, CountsTheFormulasOfAPair) {
  EXPECT_EQ(candidate_test(), (Operations{3, 1, 2, 0, 0}));
  // The test's six, root, two nfma, uu, uu + uu, w w w, fms, and the sum.
  EXPECT_EQ(density_pair(Pressure::wcsph), (Operations{5, 4, 5, 1, 0}));
  // Three differences, three nfma, t t t, and the sum.
  EXPECT_EQ(density_pair(Pressure::mueller), (Operations{4, 2, 3, 0, 0}));
  // r + tiny, no viscosity: 3 differences and that; r2, p p_j: 1 + 1 product u u, and pressures u^2; r2, u, fma
  // pressures and three of the sum.
  EXPECT_EQ(force_pair(Pressure::mueller, false), (Operations{4, 3, 7, 1, 1}));
}

TEST(WorkModel, AFusedMultiplyAddIsTwoFlops) { EXPECT_EQ((Operations{1, 2, 3, 4, 5}).flops(), 1 + 2 + 6 + 4 + 5); }

TEST(WorkModel, ViscosityCostsMore) {
  for (const Pressure pressure : {Pressure::wcsph, Pressure::mueller})
    EXPECT_GT(force_pair(pressure, true).flops(), force_pair(pressure, false).flops());
}

Particles random_particles(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  Particles particles;
  for (std::size_t i = 0; i < count; ++i)
    particles.add(
        static_cast<std::uint32_t>(i),
        Eigen::Vector3d(0.8 * unit(random), 0.6 * unit(random), 0.4 * unit(random)).cast<float>().cast<double>(),
        Eigen::Vector3d::Zero());
  return particles;
}

// Lane by lane: the list of a particle alone is its neighbours and itself.
TEST(PairSlots, OfSingleParticlesAreTheirNeighbours) {
  const Particles particles = random_particles(501);
  const auto params = to_single(make_params(test::empty_tank(), Pressure::wcsph));
  double pairs = 0, candidates = 0;
  for (const auto& a : particles.positions)
    for (const auto& b : particles.positions) {
      pairs += (a.cast<float>() - b.cast<float>()).squaredNorm() < params.list_squared;
      const auto cell = [&](double x, float inverse, int cells) {
        return cell_coordinate(static_cast<float>(x), inverse, cells);
      };
      const auto apart = [&](int axis, float inverse, int cells) {
        return std::abs(cell(a[axis], inverse, cells) - cell(b[axis], inverse, cells));
      };
      candidates += apart(0, params.inverse_edge_x, params.cells_x) <= k_x_fineness &&
                    apart(1, params.inverse_edge_yz, params.cells_y) <= 1 &&
                    apart(2, params.inverse_edge_yz, params.cells_z) <= 1;
    }
  const PairSlots slots = count_pair_slots(params, particles, 1, 1'000'000);
  EXPECT_DOUBLE_EQ(slots.listed, pairs / 501);
  EXPECT_DOUBLE_EQ(slots.entries, slots.listed);
  EXPECT_DOUBLE_EQ(slots.boxed, slots.listed) << "the box around one particle is that particle";
  EXPECT_DOUBLE_EQ(slots.candidates, candidates / 501);
  EXPECT_DOUBLE_EQ(slots.culled, slots.candidates);
}

// More lanes share entries but waste slots; nothing can be in fewer slots than a particle's own neighbours.
TEST(PairSlots, WiderBlocksShareEntriesAndWasteSlots) {
  const Particles particles = random_particles(5003);
  const auto params = to_single(make_params(test::empty_tank(), Pressure::wcsph));
  const PairSlots one = count_pair_slots(params, particles, 1, 1'000'000);
  const PairSlots eight = count_pair_slots(params, particles, 8, 1'000'000);
  EXPECT_LT(eight.entries, one.entries);
  EXPECT_GT(eight.listed, one.listed);
  EXPECT_GT(eight.candidates, one.candidates);
  EXPECT_GT(eight.boxed, eight.listed) << "the box has corners where nothing is";
  EXPECT_LT(eight.boxed, eight.candidates);
  EXPECT_GT(eight.culled, eight.candidates / 8) << "the last vector of a range is partly empty";
  EXPECT_LT(eight.culled, eight.candidates / 8 + 9 * 7) << "by less than a vector in each of nine ranges";
  const PairSlots sampled = count_pair_slots(params, particles, 8, 300);
  EXPECT_NEAR(sampled.listed, eight.listed, 0.1 * eight.listed) << "a sample of two blocks in three";
}

TEST(PairSlots, NothingHasNone) {
  const auto params = to_single(make_params(test::empty_tank(), Pressure::wcsph));
  EXPECT_EQ(count_pair_slots(params, Particles{}, 8, 100).candidates, 0.0);
}

TEST(LeastTime, IsWhatTheScarcestUnitNeeds) {
  Bounds bounds;
  for (const Operation operation : k_operations) bounds.rates[static_cast<std::size_t>(operation)] = 1e9;
  bounds.rates[static_cast<std::size_t>(Operation::mixed)] = 2e9;
  bounds.bytes = 1e10;
  const auto bound = [&](const Operations& operations, double bytes) { return least_time(operations, bytes, bounds); };
  EXPECT_EQ(bound({1, 2, 3, 0, 0}, 0).bound_by, "fma and mul");
  EXPECT_DOUBLE_EQ(bound({1, 2, 3, 0, 0}, 0).seconds, 5e-9);
  EXPECT_EQ(bound({7, 2, 3, 0, 0}, 0).bound_by, "add");
  EXPECT_EQ(bound({7, 2, 3, 5, 5}, 0).bound_by, "sqrt+div");
  EXPECT_DOUBLE_EQ(bound({7, 2, 3, 5, 5}, 0).seconds, 1e-8);
  EXPECT_EQ(bound({7, 2, 3, 5, 5}, 1000).bound_by, "memory");
  EXPECT_DOUBLE_EQ(bound({7, 2, 3, 5, 5}, 1000).seconds, 1e-7);
  bounds.rates[static_cast<std::size_t>(Operation::fma)] = 1e8;
  EXPECT_EQ(bound({1, 2, 3, 0, 0}, 0).bound_by, "fma") << "a library call where there is no such instruction";
  EXPECT_DOUBLE_EQ(bound({1, 2, 3, 0, 0}, 0).seconds, 3e-8);
  bounds.rates[static_cast<std::size_t>(Operation::fma)] = 1e9;
  bounds.rates[static_cast<std::size_t>(Operation::mixed)] = 1e9;
  EXPECT_EQ(bound({2, 2, 1, 0, 0}, 0).bound_by, "mul+add") << "units that share a port";
}

TEST(WorkModel, AStepIsItsStages) {
  WorkOf of;
  of.pressure = Pressure::mueller;
  of.walk = {8, Way::box_and_list};
  of.particles = 1000;
  of.neighbours_mean = 30;
  of.cells = 100;
  of.threads = 2;
  of.slots = {250, 40, 160, 120, 15};
  EXPECT_EQ(work_of(Stage::sort, of).operations.flops(), 0);
  EXPECT_DOUBLE_EQ(work_of(Stage::sort, of).bytes, 1000 * (76 + 12) + 100 * 4 * 7);
  EXPECT_DOUBLE_EQ(work_of(Stage::density, of).operations.add, 1000 * (40 * 3 + 160 * 4));
  EXPECT_DOUBLE_EQ(work_of(Stage::density, of).bytes, 1000 * (64 + 12 + 8 + 60));
  EXPECT_DOUBLE_EQ(work_of(Stage::forces, of).operations.divide, 1000 * 120);
  EXPECT_DOUBLE_EQ(work_of(Stage::forces, of).useful.divide, 1000 * 31);
  EXPECT_DOUBLE_EQ(work_of(Stage::forces, of).bytes, 1000 * (64 + 8 + 60 + 4) + 100 * 4 * 2);
  of.walk.way = Way::every_candidate;
  EXPECT_DOUBLE_EQ(work_of(Stage::sort, of).bytes, 1000 * (36 + 76) + 100 * 4 * 9);
  EXPECT_DOUBLE_EQ(work_of(Stage::density, of).operations.add, 1000 * (250 * 3 + 120 * 4));
  EXPECT_DOUBLE_EQ(work_of(Stage::forces, of).operations.multiply,
                   1000 * (250 + 120 * force_pair(Pressure::mueller, false).multiply));
  EXPECT_DOUBLE_EQ(work_of(Stage::density, of).bytes, 1000 * (64 + 8));
}

}  // namespace
}  // namespace squall::bench
