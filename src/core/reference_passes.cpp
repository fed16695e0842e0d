#include "core/reference_passes.h"

#include <algorithm>

namespace squall::reference {

template <class Scalar>
Scalar opening(const Params<Scalar>& p, int kernel_shape, bool for_density, const Walls<Scalar>& walls, const Scalar* x,
               Scalar* gradient) {
  const Scalar shift = for_density ? p.density_wall_shift : p.force_wall_shift;
  Scalar open = container_opening(&p, kernel_shape, shift, x[0], x[1], x[2], &gradient[0], &gradient[1], &gradient[2]);
  for (int b = 0; b < walls.box_count; ++b) {
    const Box<Scalar>& box = walls.boxes[b];
    open = close_box(&p, kernel_shape, for_density ? box.density_min : box.force_min,
                     for_density ? box.density_max : box.force_max, x[0], x[1], x[2], open, &gradient[0], &gradient[1],
                     &gradient[2]);
  }
  return open;
}

namespace {

template <class Scalar>
void wcsph_forces(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls,
                  SortedParticles<Scalar>& sorted, int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  Scalar sum[3] = {};
  for_each_candidate(p, sorted, i, [&](int j) {
    const Particle<Scalar>& b = sorted.particles[static_cast<std::size_t>(j)];
    const Scalar x = a.x[0] - b.x[0], y = a.x[1] - b.x[1], z = a.x[2] - b.x[2];
    const Scalar r2 = squared_length(x, y, z);
    const Scalar r = sqrt(r2);
    const Scalar u = remaining_support(r, p.inverse_support);
    const Scalar w = remaining_support(r, p.inverse_half_support);
    const Scalar receding = dot_product(x, y, z, a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2]);
    Scalar shear = p.artificial_scale * max0(-receding);
    if (terms.viscosity) shear = fma(-p.viscosity_scale, receding, shear);
    const Scalar s = wcsph_pair(r, r2, cubic_slope(u, w), a.pressure_term + b.pressure_term,
                                a.volume_term + b.volume_term, shear, p.softening, p.tiny);
    sum[0] = fma(s, x, sum[0]);
    sum[1] = fma(s, y, sum[1]);
    sum[2] = fma(s, z, sum[2]);
  });
  Scalar gradient[3];
  opening(p, SQUALL_CUBIC, false, walls, a.x, gradient);
  for (int axis = 0; axis < 3; ++axis)
    a.acceleration[axis] = fma(p.force_scale, sum[axis], a.pressure_term * gradient[axis]);
}

template <class Scalar>
void mueller_forces(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls,
                    SortedParticles<Scalar>& sorted, int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  Scalar push[3] = {}, drag[3] = {};
  for_each_candidate(p, sorted, i, [&](int j) {
    const Particle<Scalar>& b = sorted.particles[static_cast<std::size_t>(j)];
    const Scalar x = a.x[0] - b.x[0], y = a.x[1] - b.x[1], z = a.x[2] - b.x[2];
    const Scalar r = sqrt(squared_length(x, y, z));
    const Scalar u = remaining_support(r, p.inverse_support);
    const Scalar s = mueller_pair(r, u, a.pressure, b.volume_term, b.pressure_term, p.tiny);
    push[0] = fma(s, x, push[0]);
    push[1] = fma(s, y, push[1]);
    push[2] = fma(s, z, push[2]);
    if (terms.viscosity) {
      const Scalar weight = viscosity_laplacian(u) * b.volume_term;
      drag[0] = fma(weight, b.v[0] - a.v[0], drag[0]);
      drag[1] = fma(weight, b.v[1] - a.v[1], drag[1]);
      drag[2] = fma(weight, b.v[2] - a.v[2], drag[2]);
    }
  });
  Scalar gradient[3];
  opening(p, SQUALL_SPIKY, false, walls, a.x, gradient);
  for (int axis = 0; axis < 3; ++axis) {
    Scalar force = fma(p.force_scale, push[axis], a.pressure * gradient[axis]);
    if (terms.viscosity) force = fma(p.viscosity_scale, drag[axis], force);
    a.acceleration[axis] = force / a.density;
  }
}

}  // namespace

template <class Scalar>
void sort(const Params<Scalar>& p, const std::vector<HeldGroup>& groups, int held_count,
          SortedParticles<Scalar>& sorted) {
  const auto cell = [&](const Particle<Scalar>& particle) {
    if (is_lost(particle.x[0])) return lost_cell(&p);
    for (int g = 0; g < held_count; ++g) {
      const HeldGroup& group = groups[static_cast<std::size_t>(g)];
      if (particle.id >= group.first_id && particle.id < group.end_id) return held_cell(&p);
    }
    return cell_of(&p, particle.x[0], particle.x[1], particle.x[2]);
  };
  std::stable_sort(sorted.particles.begin(), sorted.particles.end(),
                   [&](const auto& a, const auto& b) { return cell(a) < cell(b); });
  sorted.cell_start.assign(static_cast<std::size_t>(p.cell_count) + 3, 0);
  for (const auto& particle : sorted.particles) ++sorted.cell_start[static_cast<std::size_t>(cell(particle)) + 1];
  for (std::size_t c = 1; c < sorted.cell_start.size(); ++c) sorted.cell_start[c] += sorted.cell_start[c - 1];
}

template <class Scalar>
void density(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls, SortedParticles<Scalar>& sorted,
             int i) {
  Particle<Scalar>& a = sorted.particles[static_cast<std::size_t>(i)];
  const bool wcsph = terms.pressure == Pressure::wcsph;
  Scalar sums[2] = {};  // by the parity of the sorted index
  a.neighbours = -1;    // self is a candidate of its own
  for_each_candidate(p, sorted, i, [&](int j) {
    const Particle<Scalar>& b = sorted.particles[static_cast<std::size_t>(j)];
    const Scalar x = a.x[0] - b.x[0], y = a.x[1] - b.x[1], z = a.x[2] - b.x[2];
    if (wcsph) {
      const Scalar r = sqrt(squared_length(x, y, z));
      const Scalar u = remaining_support(r, p.inverse_support);
      sums[j & 1] += cubic_value(u, remaining_support(r, p.inverse_half_support));
      a.neighbours += u > 0;
    } else {
      const Scalar t = squared_support_left(x, y, z, p.support_squared);
      sums[j & 1] += poly6_value(t);
      a.neighbours += t > 0;
    }
  });
  const Scalar sum = sums[0] + sums[1];
  Scalar gradient[3];
  a.wall_share = 1 - opening(p, wcsph ? SQUALL_CUBIC : SQUALL_POLY6, true, walls, a.x, gradient);
  a.density = relative_density(sum, p.density_scale, a.wall_share);
  a.isolation = isolation(sum, p.self_value, p.density_scale, a.wall_share, p.steepness);
  if (wcsph) {
    a.pressure = tait_pressure(a.density, p.stiffness);
    a.volume_term = 1 / a.density;
    a.pressure_term = a.pressure / (a.density * a.density);
  } else {
    a.pressure = mueller_pressure(a.density, p.stiffness, p.tension);
    a.volume_term = p.one_half / a.density;
    a.pressure_term = a.pressure * a.volume_term;
  }
}

template <class Scalar>
void forces(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls, SortedParticles<Scalar>& sorted,
            int i) {
  if (terms.pressure == Pressure::wcsph)
    wcsph_forces(p, terms, walls, sorted, i);
  else
    mueller_forces(p, terms, walls, sorted, i);
}

template <class Scalar>
void add_external_acceleration(const Params<Scalar>& p, const Terms& terms, const Substep<Scalar>& substep,
                               Particle<Scalar>& particle) {
  Scalar* a = particle.acceleration;
  a[0] += substep.acceleration_x;
  a[1] += substep.acceleration_y;
  a[2] += substep.acceleration_z;
  if (!terms.drag) return;
  // Midpoint rule: the drag of the speed half a kick from now.
  const Scalar half_kick = substep.kick * p.one_half;
  const Scalar wind[3] = {substep.wind_x, substep.wind_y, substep.wind_z};
  Scalar now[3], then[3];
  for (int axis = 0; axis < 3; ++axis) now[axis] = particle.v[axis] - wind[axis];
  const Scalar rate = drag_rate(now[0], now[1], now[2], p.drag_coefficient, particle.isolation);
  for (int axis = 0; axis < 3; ++axis) then[axis] = fma(half_kick, fma(rate, now[axis], a[axis]), now[axis]);
  const Scalar rate_then = drag_rate(then[0], then[1], then[2], p.drag_coefficient, particle.isolation);
  for (int axis = 0; axis < 3; ++axis) a[axis] = fma(rate_then, then[axis], a[axis]);
}

template <class Scalar>
int drift(const Params<Scalar>& p, const Walls<Scalar>& walls, const Substep<Scalar>& substep,
          Particle<Scalar>& particle) {
  Scalar* x = particle.x;
  const Scalar from[3] = {x[0], x[1], x[2]};
  for (int axis = 0; axis < 3; ++axis) x[axis] = fma(substep.dt, particle.v[axis], x[axis]);
  return keep_inside(&p, walls.boxes, walls.box_count, from, x, particle.v);
}

template <class Scalar>
int integrate(const Params<Scalar>& p, const Terms& terms, const Walls<Scalar>& walls, const Substep<Scalar>& substep,
              Particle<Scalar>& particle) {
  add_external_acceleration(p, terms, substep, particle);
  for (int axis = 0; axis < 3; ++axis)
    particle.v[axis] = fma(substep.kick, particle.acceleration[axis], particle.v[axis]);
  return drift(p, walls, substep, particle);
}

// NOLINTBEGIN(bugprone-macro-parentheses): the argument is a type
#define SQUALL_INSTANTIATE(Scalar)                                                                                 \
  template void sort(const Params<Scalar>&, const std::vector<HeldGroup>&, int, SortedParticles<Scalar>&);         \
  template void density(const Params<Scalar>&, const Terms&, const Walls<Scalar>&, SortedParticles<Scalar>&, int); \
  template void forces(const Params<Scalar>&, const Terms&, const Walls<Scalar>&, SortedParticles<Scalar>&, int);  \
  template Scalar opening(const Params<Scalar>&, int, bool, const Walls<Scalar>&, const Scalar*, Scalar*);         \
  template void add_external_acceleration(const Params<Scalar>&, const Terms&, const Substep<Scalar>&,             \
                                          Particle<Scalar>&);                                                      \
  template int drift(const Params<Scalar>&, const Walls<Scalar>&, const Substep<Scalar>&, Particle<Scalar>&);      \
  template int integrate(const Params<Scalar>&, const Terms&, const Walls<Scalar>&, const Substep<Scalar>&,        \
                         Particle<Scalar>&);
SQUALL_INSTANTIATE(float)
SQUALL_INSTANTIATE(double)
#undef SQUALL_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace squall::reference
