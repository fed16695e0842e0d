#include <algorithm>

#include "harness/stress/cases.h"

namespace squall::harness::stress {

namespace {

Scene stirred_scene(std::size_t count) {
  Scene scene = with_room_for(stress_tank({0.8, 0.8, 0.4}), count);
  scene.solver.speed_of_sound_m_s = 20.0;
  return scene;
}

/// The same particles in another order, ids kept.
Particles shuffled(const Particles& particles) {
  Particles result;
  const std::size_t n = particles.size(), stride = 611;  // coprime to 8^3
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = k * stride % n;
    result.add(particles.ids[i], particles.positions[i], particles.velocities[i]);
  }
  return result;
}

}  // namespace

/// Another order of the same particles sums in another order: rounding apart, the same water. Another number of
/// threads, or another width of vectors, is the same to the bit.
void order(Bench bench, Outcome outcome) {
  const Particles start = shaken_cube(8, k_stress_spacing, {0.1, 0.05, 0.0}, 0.01, 0.2, 23);
  const Scene scene = stirred_scene(start.size());
  const auto solver = bench.make(scene), other = bench.make(scene);
  solver->load(start);
  other->load(shuffled(start));
  std::int64_t steps = 0;
  while (steps < 10) {
    steps += run_frames(*solver, 1).substeps;
    run_frames(*other, 1);
  }
  const Particles expected = solver->state().particles;
  outcome.at_most("distance after 10 steps in another order [dx]",
                  largest_distance(expected, other->state().particles) / k_stress_spacing, 1e-5);
  if (bench.backend() == "reference") return;
  int differing = 0, tried = 0;
  const auto compare = [&](const Settings& settings) {
    const auto one = bench.make(scene, settings);
    one->load(start);
    std::int64_t done = 0;
    while (done < steps) done += run_frames(*one, 1).substeps;
    ++tried;
    differing += same_bits(expected, one->state().particles) ? 0 : 1;
  };
  if (bench.backend() == "omp")
    for (const int threads : {1, 2, 3, 8, 64}) {
      Settings settings = bench.settings();
      settings.threads = threads;
      compare(settings);
    }
  std::vector<Simd> widths = {Simd::scalar};
  if (bench.backend() == "opencl") widths.push_back(Simd::avx2);  // eight lanes, on any device
  for (const Simd simd : widths) {
    Settings settings = bench.settings();
    settings.simd = simd;
    compare(settings);
  }
  outcome.equal("of " + std::to_string(tried) + " ways to share the work, with other bits", differing, 0.0);
}

}  // namespace squall::harness::stress
