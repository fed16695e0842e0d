#include "core/reference_dfsph.h"

#include <algorithm>

#include "core/convergence.h"
#include "dfsph_formulas.h"
#include "wall_cores.h"

namespace squall::reference {

namespace {

/// Open share at a particle with the walls' cores, and its gradient.
template <class Scalar>
Scalar opening_with_cores(const Params<Scalar>& p, const Walls<Scalar>& walls, const Scalar* x, Scalar* gradient) {
  Scalar open = opening(p, SQUALL_BELL, true, walls, x, gradient);
  open = close_container_cores(&p, x[0], x[1], x[2], open, &gradient[0], &gradient[1], &gradient[2]);
  for (int b = 0; b < walls.box_count; ++b)
    open = close_box_core(&p, &walls.boxes[b], x[0], x[1], x[2], open, &gradient[0], &gradient[1], &gradient[2]);
  return open;
}

/// Particle i seen from particle j.
template <class Scalar>
struct Pair {
  Scalar x, y, z, r2, left, weight;

  Pair(const Params<Scalar>& p, const Particle<Scalar>& a, const Particle<Scalar>& b)
      : x(a.x[0] - b.x[0]),
        y(a.x[1] - b.x[1]),
        z(a.x[2] - b.x[2]),
        r2(squared_length(x, y, z)),
        left(bell_left(r2, p.inverse_support_squared)),
        weight(bell_weight(left)) {}

  Scalar receding(const Particle<Scalar>& a, const Particle<Scalar>& b) const {
    return dot_product(x, y, z, a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2]);
  }
  void add_scaled(Scalar s, Scalar* sum) const {
    sum[0] = fma(s, x, sum[0]);
    sum[1] = fma(s, y, sum[1]);
    sum[2] = fma(s, z, sum[2]);
  }
};

/// Calls visit(b, pair, j) for every particle b that is near enough to count, in canonical order. Further ones would
/// add exactly zero.
template <class Scalar, class Visit>
void for_each_neighbour(const Params<Scalar>& p, const SortedParticles<Scalar>& sorted, int i, Visit visit) {
  const Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  for_each_candidate(p, sorted, i, [&](int j) {
    const Particle<Scalar>& b = sorted.particles[static_cast<std::size_t>(j)];
    if (squared_length(a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]) < p.list_squared)
      visit(b, Pair<Scalar>(p, a, b), j);
  });
}

/// One particle's part of an iteration: its error, and by how much its impulse changes.
template <class Scalar>
std::int64_t iterate(const Params<Scalar>& p, const Substep<Scalar>& substep, Scalar momentum,
                     SortedParticles<Scalar>& sorted, int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  const Scalar lack = lack_of_compression(a.room, substep.dt, compression_rate_of(p, sorted, i));
  const Scalar projected = projected_impulse(a.impulse, lack, substep.relaxation_rate, a.inverse_response);
  a.change = extrapolated_impulse(projected, a.projected, momentum) - a.impulse;
  a.projected = projected;
  return convergence_term(solve_error(lack, a.impulse, substep.dt, a.response, a.inverse_response));
}

/// Sum of what is beyond rest density.
template <class Scalar>
std::int64_t sum_of_excess(const SortedParticles<Scalar>& sorted) {
  std::int64_t sum = 0;
  for (int i = 0; i < sorted.active(); ++i)
    sum += convergence_term(sorted.particles[static_cast<std::size_t>(i)].density - 1);
  return sum;
}

template <class Scalar>
void start_from(Scalar impulse, Particle<Scalar>& particle) {
  particle.impulse = particle.projected = impulse;
}

}  // namespace

template <class Scalar>
void prepare(const Params<Scalar>& p, const Walls<Scalar>& walls, SortedParticles<Scalar>& sorted, int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  Scalar sums[2] = {};  // by the parity of the sorted index
  Scalar apart[3] = {}, squares = 0;
  a.neighbours = -1;  // self is a candidate of its own
  for_each_neighbour(p, sorted, i, [&](const Particle<Scalar>&, const Pair<Scalar>& pair, int j) {
    sums[j & 1] += bell_value(pair.left);
    a.neighbours += pair.left > 0;
    pair.add_scaled(pair.weight, apart);
    squares = plus_squared_slope(squares, pair.weight, pair.r2);
  });
  const Scalar sum = sums[0] + sums[1];
  a.wall_share = 1 - opening_with_cores(p, walls, a.x, a.opening_gradient);
  a.density = relative_density(sum, p.density_scale, a.wall_share);
  a.isolation = isolation(sum, p.self_value, p.density_scale, a.wall_share, p.steepness);
  for (int axis = 0; axis < 3; ++axis) a.descent[axis] = fma(p.force_scale, apart[axis], a.opening_gradient[axis]);
  a.response = pressure_response(a.descent[0], a.descent[1], a.descent[2], squares, p.force_scale);
  a.inverse_response = inverse_response(a.response, p.response_guard);
}

template <class Scalar>
Scalar compression_rate_of(const Params<Scalar>& p, const SortedParticles<Scalar>& sorted, int i) {
  const Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  Scalar sum = 0;
  for_each_neighbour(p, sorted, i, [&](const Particle<Scalar>& b, const Pair<Scalar>& pair, int) {
    sum = fma(pair.weight, dot_product(pair.x, pair.y, pair.z, b.v[0], b.v[1], b.v[2]), sum);
  });
  const Scalar* h = a.descent;
  return compression_rate(sum, p.force_scale, dot_product(a.v[0], a.v[1], a.v[2], h[0], h[1], h[2]));
}

template <class Scalar>
void predict(const Params<Scalar>& p, const Terms& terms, const Substep<Scalar>& substep,
             SortedParticles<Scalar>& sorted, int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  const Scalar viscous = p.viscosity_scale * substep.kick;
  Scalar pushed[3] = {}, smoothed[3] = {};
  for_each_neighbour(p, sorted, i, [&](const Particle<Scalar>& b, const Pair<Scalar>& pair, int) {
    Scalar impulse = b.impulse;
    if (terms.viscosity) impulse = viscous_pair_push(impulse, viscous, pair.receding(a, b));
    pair.add_scaled(impulse * pair.weight, pushed);
    if (!terms.smoothing) return;
    const Scalar value = bell_value(pair.left);
    for (int axis = 0; axis < 3; ++axis) smoothed[axis] = fma(value, b.v[axis] - a.v[axis], smoothed[axis]);
  });
  for (Scalar& component : a.acceleration) component = 0;
  add_external_acceleration(p, terms, substep, a);
  for (int axis = 0; axis < 3; ++axis) {
    a.next_v[axis] = fma(substep.kick, a.acceleration[axis], a.v[axis]) +
                     fma(p.force_scale, pushed[axis], a.impulse * a.descent[axis]);
    if (terms.smoothing) a.next_v[axis] = fma(p.smoothing_scale * substep.dt, smoothed[axis], a.next_v[axis]);
  }
}

template <class Scalar>
void push(const Params<Scalar>& p, SortedParticles<Scalar>& sorted, int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  Scalar sum[3] = {};
  for_each_neighbour(p, sorted, i, [&](const Particle<Scalar>& b, const Pair<Scalar>& pair, int) {
    pair.add_scaled(b.change * pair.weight, sum);
  });
  for (int axis = 0; axis < 3; ++axis) a.v[axis] += fma(p.force_scale, sum[axis], a.change * a.descent[axis]);
  a.impulse = max0(a.impulse + a.change);
}

template <class Scalar>
int solve(const Params<Scalar>& p, const Substep<Scalar>& substep, const SolveLimits& limits,
          SortedParticles<Scalar>& sorted, SolveCost& cost) {
  const int active = sorted.active();
  const std::int64_t limit = convergence_limit(limits.tolerance, active);
  Momentum momentum;
  for (int iteration = 1;; ++iteration) {
    const Scalar reach = momentum.next<Scalar>();
    std::int64_t sum = 0;
    for (int i = 0; i < active; ++i) sum += iterate(p, substep, reach, sorted, i);
    momentum.found(sum);
    if (sum <= limit && iteration >= limits.least) return iteration;
    if (iteration >= limits.most) {
      cost.unconverged += sum > limit;
      return iteration;
    }
    for (int i = 0; i < active; ++i) push(p, sorted, i);
  }
}

template <class Scalar>
void make_incompressible(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls,
                         const Substep<Scalar>& substep, const Scene::Solver& settings, SortedParticles<Scalar>& sorted,
                         SolveCost& cost) {
  const int active = sorted.active();
  const auto each = [&](auto&& visit) {
    for (int i = 0; i < active; ++i) visit(sorted.particles[static_cast<std::size_t>(i)], i);
  };
  each([&](auto& particle, int i) {
    prepare(p, walls, sorted, i);
    particle.room = divergence_room(particle.density, p.free_density);
    start_from(Scalar(0), particle);
    std::copy(particle.v, particle.v + 3, particle.start_v);
  });
  cost.divergence_iterations +=
      solve(p, substep, {settings.divergence_tolerance, 1, settings.max_iterations}, sorted, cost);
  const Scalar correction = correction_share(sum_of_excess(sorted), substep.correction, active);
  each([&](auto& particle, int) {
    particle.room = density_room(particle.density, correction);
    const Scalar largest = p.largest_warm_impulse / substep.dt;
    start_from(warm_impulse(particle.pressure, substep.warm_kick, largest), particle);
  });
  each([&](auto&, int i) { predict(p, terms, substep, sorted, i); });
  each([](auto& particle, int) { std::copy(particle.next_v, particle.next_v + 3, particle.v); });
  cost.density_iterations += solve(p, substep, {settings.density_tolerance, 2, settings.max_iterations}, sorted, cost);
  each([&](auto& particle, int) {
    particle.pressure = particle.impulse * substep.inverse_kick;
    for (int axis = 0; axis < 3; ++axis)
      particle.acceleration[axis] = (particle.v[axis] - particle.start_v[axis]) * substep.inverse_kick;
  });
}

#define SQUALL_INSTANTIATE(Scalar)                                                                                     \
  template void prepare(const Params<Scalar>&, const Walls<Scalar>&, SortedParticles<Scalar>&, int);                   \
  template Scalar compression_rate_of(const Params<Scalar>&, const SortedParticles<Scalar>&, int);                     \
  template void predict(const Params<Scalar>&, const Terms&, const Substep<Scalar>&, SortedParticles<Scalar>&, int);   \
  template void push(const Params<Scalar>&, SortedParticles<Scalar>&, int);                                            \
  template int solve(const Params<Scalar>&, const Substep<Scalar>&, const SolveLimits&, SortedParticles<Scalar>&,      \
                     SolveCost&);                                                                                      \
  template void make_incompressible(const Params<Scalar>&, const Terms&, const Walls<Scalar>&, const Substep<Scalar>&, \
                                    const Scene::Solver&, SortedParticles<Scalar>&, SolveCost&);
SQUALL_INSTANTIATE(float)
SQUALL_INSTANTIATE(double)
#undef SQUALL_INSTANTIATE

}  // namespace squall::reference
