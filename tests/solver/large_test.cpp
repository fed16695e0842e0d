// 2^20 + 1 particles: the order against std::stable_sort, the neighbours of 500 particles against brute force, and
// those of all against a search that shares nothing with the solvers' grid but the distance's formula.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <tuple>

#include "grid.h"
#include "solver/backends_under_test.h"
#include "sph_formulas.h"

namespace squall::test {
namespace {

constexpr int k_count = (1 << 20) + 1;
constexpr int k_edge = 102;  // 102^3 lattice points hold them

/// A cube whose sound is so slow that a frame is one sub-step.
Scene large_scene() {
  Scene scene;
  scene.time.duration_s = 1;
  scene.time.frame_rate_hz = 1000;
  scene.fluid.spacing_m = 0.01;
  scene.solver.speed_of_sound_m_s = 1;
  scene.solver.stiffness_m2_s2 = 1;
  scene.container.max_m = Eigen::Vector3d::Constant(k_edge * scene.fluid.spacing_m);
  Scene::Block block;
  block.min_m = scene.container.min_m;
  block.max_m = scene.container.max_m;
  scene.blocks.push_back(block);
  return scene;
}

/// A jittered lattice in shuffled order, exact in single precision.
Particles jittered_particles(double dx) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  std::vector<int> places(k_edge * k_edge * k_edge);
  std::iota(places.begin(), places.end(), 0);
  std::shuffle(places.begin(), places.end(), random);
  Particles particles;
  for (int i = 0; i < k_count; ++i) {
    const int place = places[static_cast<std::size_t>(i)];
    const Eigen::Vector3d index(place % k_edge, place / k_edge % k_edge, place / k_edge / k_edge);
    const Eigen::Vector3d offset(jitter(random), jitter(random), jitter(random));
    const Eigen::Vector3d x = dx * (index + Eigen::Vector3d::Constant(0.5) + offset);
    particles.add(static_cast<std::uint32_t>(i), x.cast<float>().cast<double>(), Eigen::Vector3d::Zero());
  }
  return particles;
}

class Neighbours {
 public:
  Neighbours(const Particles& particles, const Scene& scene)
      : inverse_support_(static_cast<float>(1.0 / scene.support_radius())), cell_(scene.support_radius() * 1.001) {
    for (const auto& x : particles.positions) {
      positions_.push_back(x.cast<float>());
      bucket_at(bucket(x)).push_back(static_cast<int>(positions_.size()) - 1);
    }
  }

  int brute_force(int i) const {
    int count = 0;
    for (int j = 0; j < k_count; ++j) count += j != i && within(i, j);
    return count;
  }

  int by_buckets(int i) const {
    int count = 0;
    const auto [x, y, z] = bucket(positions_[static_cast<std::size_t>(i)].cast<double>());
    for (int k = z - 1; k <= z + 1; ++k)
      for (int j = y - 1; j <= y + 1; ++j)
        for (int l = x - 1; l <= x + 1; ++l) {
          for (const int other : bucket_at({l, j, k})) count += other != i && within(i, other);
        }
    return count;
  }

 private:
  using Bucket = std::tuple<int, int, int>;
  Bucket bucket(const Eigen::Vector3d& x) const {
    return {static_cast<int>(x.x() / cell_), static_cast<int>(x.y() / cell_), static_cast<int>(x.z() / cell_)};
  }
  /// Those one step outside the cube exist and stay empty.
  static std::size_t index(const Bucket& bucket) {
    const auto [x, y, z] = bucket;
    return static_cast<std::size_t>(((z + 1) * k_side + y + 1) * k_side + x + 1);
  }
  std::vector<int>& bucket_at(const Bucket& bucket) { return buckets_[index(bucket)]; }
  const std::vector<int>& bucket_at(const Bucket& bucket) const { return buckets_[index(bucket)]; }
  bool within(int i, int j) const {
    const Eigen::Vector3f d = positions_[static_cast<std::size_t>(i)] - positions_[static_cast<std::size_t>(j)];
    return remaining_support(std::sqrt(squared_length(d.x(), d.y(), d.z())), inverse_support_) > 0.0f;
  }

  float inverse_support_;
  double cell_;
  std::vector<Eigen::Vector3f> positions_;
  static constexpr int k_side = k_edge / 2 + 3;
  std::vector<std::vector<int>> buckets_{static_cast<std::size_t>(k_side) * k_side * k_side};
};

std::vector<std::uint32_t> stably_sorted_ids(const Particles& particles, const Scene& scene) {
  const Params<float> p = to_single(make_params(scene, Pressure::wcsph));
  std::vector<std::pair<int, std::uint32_t>> keyed;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Eigen::Vector3f x = particles.positions[i].cast<float>();
    keyed.emplace_back(cell_of(&p, x.x(), x.y(), x.z()), particles.ids[i]);
  }
  std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::uint32_t> ids;
  for (const auto& [cell, id] : keyed) ids.push_back(id);
  return ids;
}

TEST(Large, OrderAndNeighbours) {
  const Scene scene = large_scene();
  const Particles particles = jittered_particles(scene.fluid.spacing_m);
  const Neighbours neighbours(particles, scene);
  std::mt19937 random(21);
  for (int sample = 0; sample < 500; ++sample) {
    const auto i = static_cast<int>(random() % k_count);
    ASSERT_EQ(neighbours.by_buckets(i), neighbours.brute_force(i)) << "particle " << i;
  }
  std::int64_t total = 0;
  for (int i = 0; i < k_count; ++i) total += neighbours.by_buckets(i);
  const std::vector<std::uint32_t> expected_ids = stably_sorted_ids(particles, scene);

  for (const BackendUnderTest& backend :
       {omp("2_threads", 2, Simd::best, Pressure::wcsph), opencl("by_device", Simd::best, Pressure::wcsph)}) {
    SCOPED_TRACE(backend.name);
    const auto solver = backend.make(scene);
    solver->load(particles);
    const FrameReport& report = solver->advance();
    ASSERT_EQ(report.substeps, 1);
    ASSERT_EQ(report.active, k_count);
    EXPECT_EQ(std::llround(report.neighbours_mean * k_count), total);
    EXPECT_TRUE(solver->state().particles.ids == expected_ids);
  }
}

}  // namespace
}  // namespace squall::test
