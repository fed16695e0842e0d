#pragma once

// Included once per instruction set and precision, after its Pack: what neighbours and walls do to the particles of a
// block.

#include "backend_omp/block-inl.h"

namespace squall::openmp {

namespace {

/// The records of a block, a lane each; lanes past its end hold whatever record comes next.
template <class Pack>
struct Lanes {
  Pack fields[8];
  Lanes(const Record<Scalar>* records, int begin) {
    const auto* from = reinterpret_cast<const Scalar*>(records + begin);
    load_fields(from, 0, fields);
    load_fields(from, 4, fields + 4);
  }
  Pack x() const { return fields[0]; }
  Pack y() const { return fields[1]; }
  Pack z() const { return fields[2]; }
  Pack pressure_term() const { return fields[3]; }
  Pack vx() const { return fields[4]; }
  Pack vy() const { return fields[5]; }
  Pack vz() const { return fields[6]; }
  Pack volume_term() const { return fields[7]; }
};

template <class Pack>
struct Vector {
  Pack x{0.0f}, y{0.0f}, z{0.0f};
  void add_scaled(Pack s, Pack dx, Pack dy, Pack dz) {
    x = fma(s, dx, x);
    y = fma(s, dy, y);
    z = fma(s, dz, z);
  }
};

/// What the loops over neighbours need beside the neighbour.
template <class Pack>
struct LoopConstants {
  Pack inverse_support, inverse_half_support, softening, tiny, artificial_scale, viscosity_scale;
  Pack vx, vy, vz, pressure, volume;

  LoopConstants(const Params<Scalar>& p, const Lanes<Pack>& a, Pack pressure)
      : inverse_support(p.inverse_support),
        inverse_half_support(p.inverse_half_support),
        softening(p.softening),
        tiny(p.tiny),
        artificial_scale(p.artificial_scale),
        viscosity_scale(p.viscosity_scale),
        vx(a.vx()),
        vy(a.vy()),
        vz(a.vz()),
        pressure(pressure),
        volume(a.volume_term()) {}
};

/// -(v_i - v_j) . (x_i - x_j). Here and in add_velocity the difference is taken in whichever order brings the
/// neighbour's velocity straight from memory; the bits are the same.
template <class Pack>
Pack closing_speed(const LoopConstants<Pack>& c, const Record<Scalar>& b, Pack dx, Pack dy, Pack dz) {
  const Pack vx(b.vx), vy(b.vy), vz(b.vz);
  if constexpr (Pack::k_many_registers)
    return nfma(c.vz - vz, dz, nfma(c.vy - vy, dy, nfma(c.vx - vx, dx, Pack(0.0f))));
  else
    return dot_product(dx, dy, dz, vx - c.vx, vy - c.vy, vz - c.vz);
}

/// sum + s (v_j - v_i)
template <class Pack>
void add_velocity(const LoopConstants<Pack>& c, const Record<Scalar>& b, Pack s, Vector<Pack>& sum) {
  const Pack vx(b.vx), vy(b.vy), vz(b.vz);
  if constexpr (Pack::k_many_registers)
    sum = {nfma(s, c.vx - vx, sum.x), nfma(s, c.vy - vy, sum.y), nfma(s, c.vz - vz, sum.z)};
  else
    sum.add_scaled(s, vx - c.vx, vy - c.vy, vz - c.vz);
}

/// What is under way for a stretch of a block's neighbours. Their contributions are made in three short loops instead
/// of one long one: from a pair's load to its sum lies a chain of some 65 cycles, and a processor has room for about
/// three pairs in such a chain, but for many in each of its parts.
static constexpr int k_stretch = 16;

template <class Pack>
struct Stretch {
  Pack x[k_stretch], y[k_stretch], z[k_stretch];  ///< of the block's particles, from the neighbour
  Pack r[k_stretch], r2[k_stretch], closing[k_stretch];
  Pack numerator[k_stretch], denominator[k_stretch];  ///< of what x, y, z go into the sum with
};

template <class Pack>
void add_stretch(const Stretch<Pack>& s, int count, Vector<Pack>& sum) {
  for (int k = 0; k < count; ++k) sum.add_scaled(s.numerator[k] / s.denominator[k], s.x[k], s.y[k], s.z[k]);
}

template <class Pack, bool viscous>
Vector<Pack> wcsph_acceleration(const PassContext<Scalar>& context, const Block& block, const Lanes<Pack>& a,
                                const int* list, int total) {
  const Params<Scalar>& p = *context.params;
  const Pack x = a.x(), y = a.y(), z = a.z();
  const LoopConstants<Pack> c(p, a, a.pressure_term());
  Vector<Pack> sum;
  Stretch<Pack> s;
  for (; total > 0; total -= k_stretch, list += k_stretch) {
    const int count = total < k_stretch ? total : k_stretch;
    for (int k = 0; k < count; ++k) {
      const Record<Scalar>& b = context.sorted[list[k]];
      s.x[k] = x - Pack(b.x);
      s.y[k] = y - Pack(b.y);
      s.z[k] = z - Pack(b.z);
      s.r2[k] = squared_length(s.x[k], s.y[k], s.z[k]);
      s.r[k] = sqrt(s.r2[k]);
      s.closing[k] = closing_speed(c, b, s.x[k], s.y[k], s.z[k]);
    }
    for (int k = 0; k < count; ++k) {
      const Record<Scalar>& b = context.sorted[list[k]];
      const Pack u = remaining_support(s.r[k], c.inverse_support);
      const Pack w = remaining_support(s.r[k], c.inverse_half_support);
      Pack shear = c.artificial_scale * max0(s.closing[k]);
      if constexpr (viscous) shear = fma(c.viscosity_scale, s.closing[k], shear);
      s.numerator[k] = wcsph_numerator(s.r2[k], cubic_slope(u, w), Pack(b.pressure_term) + c.pressure,
                                       Pack(b.volume_term) + c.volume, shear, c.softening);
      s.denominator[k] = wcsph_denominator(s.r[k], s.r2[k], c.softening, c.tiny);
    }
    add_stretch(s, count, sum);
  }
  const Opening<Pack> walls = opening(context, SQUALL_CUBIC, false, first_lanes(block.count()), x, y, z);
  const Pack scale(p.force_scale), pressure = a.pressure_term();
  return {fma(scale, sum.x, pressure * walls.gradient_x), fma(scale, sum.y, pressure * walls.gradient_y),
          fma(scale, sum.z, pressure * walls.gradient_z)};
}

template <class Pack, bool viscous>
Vector<Pack> mueller_acceleration(const PassContext<Scalar>& context, const Block& block, const Lanes<Pack>& a,
                                  const int* list, int total) {
  const Params<Scalar>& p = *context.params;
  const Pack x = a.x(), y = a.y(), z = a.z();
  const Pack pressure = Pack::load(context.pressure + block.begin);
  const Pack density = Pack::load(context.density + block.begin);
  const LoopConstants<Pack> c(p, a, pressure);
  Vector<Pack> push, drag;
  Stretch<Pack> s;
  for (; total > 0; total -= k_stretch, list += k_stretch) {
    const int count = total < k_stretch ? total : k_stretch;
    for (int k = 0; k < count; ++k) {
      const Record<Scalar>& b = context.sorted[list[k]];
      s.x[k] = x - Pack(b.x);
      s.y[k] = y - Pack(b.y);
      s.z[k] = z - Pack(b.z);
      s.r[k] = sqrt(squared_length(s.x[k], s.y[k], s.z[k]));
    }
    for (int k = 0; k < count; ++k) {
      const Record<Scalar>& b = context.sorted[list[k]];
      const Pack u = remaining_support(s.r[k], c.inverse_support);
      const Pack volume(b.volume_term);
      s.numerator[k] = mueller_numerator(u, c.pressure, volume, Pack(b.pressure_term));
      s.denominator[k] = s.r[k] + c.tiny;
      if constexpr (viscous) add_velocity(c, b, viscosity_laplacian(u) * volume, drag);
    }
    add_stretch(s, count, push);
  }
  const Opening<Pack> walls = opening(context, SQUALL_SPIKY, false, first_lanes(block.count()), x, y, z);
  const auto sum_up = [&](Pack pushed, Pack gradient, Pack dragged) {
    Pack force = fma(Pack(p.force_scale), pushed, pressure * gradient);
    if constexpr (viscous) force = fma(Pack(p.viscosity_scale), dragged, force);
    return force / density;
  };
  return {sum_up(push.x, walls.gradient_x, drag.x), sum_up(push.y, walls.gradient_y, drag.y),
          sum_up(push.z, walls.gradient_z, drag.z)};
}

}  // namespace

}  // namespace squall::openmp
