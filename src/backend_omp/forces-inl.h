#pragma once

// Included once per instruction set, after its Pack: what neighbours and walls do to the particles of a block.

#include "backend_omp/block-inl.h"

namespace squall::openmp {

namespace {

/// The records of a block, a lane each; lanes past its end hold whatever record comes next.
template <class Pack>
struct Lanes {
  Pack fields[8];
  Lanes(const Record* records, int begin) {
    const auto* from = reinterpret_cast<const float*>(records + begin);
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

/// What the loops over neighbours need beside the neighbour. Where there are fewer registers than that, it is read anew
/// for each neighbour, from the first-level cache: a compiler left alone keeps constants and spills the sums.
template <class Pack>
struct LoopConstants {
  Pack inverse_support, inverse_half_support, one, softening, tiny, artificial_scale, viscosity_scale;
  Pack vx, vy, vz, pressure, volume;

  LoopConstants(const Params<float>& p, const Lanes<Pack>& a, Pack pressure)
      : inverse_support(p.inverse_support),
        inverse_half_support(p.inverse_half_support),
        one(1.0f),
        softening(p.softening),
        tiny(p.tiny),
        artificial_scale(p.artificial_scale),
        viscosity_scale(p.viscosity_scale),
        vx(a.vx()),
        vy(a.vy()),
        vz(a.vz()),
        pressure(pressure),
        volume(a.volume_term()) {}

  const LoopConstants& ready() const { return Pack::k_many_registers ? *this : *reload(this); }
};

/// -(v_i - v_j) . (x_i - x_j). Here and in add_velocity the difference is taken in whichever order brings the
/// neighbour's velocity straight from memory; the bits are the same.
template <class Pack>
Pack closing_speed(const LoopConstants<Pack>& c, const Record& b, Pack dx, Pack dy, Pack dz) {
  const Pack vx(b.vx), vy(b.vy), vz(b.vz);
  if constexpr (Pack::k_many_registers)
    return nfma(c.vz - vz, dz, nfma(c.vy - vy, dy, nfma(c.vx - vx, dx, Pack(0.0f))));
  else
    return dot_product(dx, dy, dz, vx - c.vx, vy - c.vy, vz - c.vz);
}

/// sum + s (v_j - v_i)
template <class Pack>
void add_velocity(const LoopConstants<Pack>& c, const Record& b, Pack s, Vector<Pack>& sum) {
  const Pack vx(b.vx), vy(b.vy), vz(b.vz);
  if constexpr (Pack::k_many_registers)
    sum = {nfma(s, c.vx - vx, sum.x), nfma(s, c.vy - vy, sum.y), nfma(s, c.vz - vz, sum.z)};
  else
    sum.add_scaled(s, vx - c.vx, vy - c.vy, vz - c.vz);
}

template <class Pack, bool viscous>
Vector<Pack> wcsph_acceleration(const PassContext& context, const Block& block, const Lanes<Pack>& a, const int* list,
                                int count) {
  const Params<float>& p = *context.params;
  const Pack x = a.x(), y = a.y(), z = a.z();
  const LoopConstants<Pack> constants(p, a, a.pressure_term());
  Vector<Pack> sum;
  for (int k = 0; k < count; ++k) {
    const LoopConstants<Pack>& c = constants.ready();
    const Record& b = context.sorted[list[k]];
    const Pack dx = x - Pack(b.x), dy = y - Pack(b.y), dz = z - Pack(b.z);
    const Pack r2 = squared_length(dx, dy, dz);
    const Pack r = sqrt(r2);
    const Pack u = remaining_support(r, c.inverse_support);
    const Pack w = remaining_support(r, c.inverse_half_support);
    const Pack closing = closing_speed(c, b, dx, dy, dz);
    Pack shear = c.artificial_scale * max0(closing);
    if constexpr (viscous) shear = fma(c.viscosity_scale, closing, shear);
    sum.add_scaled(wcsph_pair(r, r2, cubic_slope(u, w), Pack(b.pressure_term) + c.pressure,
                              Pack(b.volume_term) + c.volume, shear, c.softening, c.tiny),
                   dx, dy, dz);
  }
  const Opening<Pack> walls = opening(context, SQUALL_CUBIC, false, first_lanes(block.count()), x, y, z);
  const Pack scale(p.force_scale), pressure = a.pressure_term();
  return {fma(scale, sum.x, pressure * walls.gradient_x), fma(scale, sum.y, pressure * walls.gradient_y),
          fma(scale, sum.z, pressure * walls.gradient_z)};
}

template <class Pack, bool viscous>
Vector<Pack> mueller_acceleration(const PassContext& context, const Block& block, const Lanes<Pack>& a, const int* list,
                                  int count) {
  const Params<float>& p = *context.params;
  const Pack x = a.x(), y = a.y(), z = a.z();
  const Pack pressure = Pack::load(context.pressure + block.begin);
  const Pack density = Pack::load(context.density + block.begin);
  const LoopConstants<Pack> constants(p, a, pressure);
  Vector<Pack> push, drag;
  for (int k = 0; k < count; ++k) {
    const LoopConstants<Pack>& c = constants.ready();
    const Record& b = context.sorted[list[k]];
    const Pack dx = x - Pack(b.x), dy = y - Pack(b.y), dz = z - Pack(b.z);
    const Pack r = sqrt(squared_length(dx, dy, dz));
    const Pack u = remaining_support(r, c.inverse_support);
    const Pack volume(b.volume_term);
    push.add_scaled(mueller_pair(r, u, c.pressure, volume, Pack(b.pressure_term), c.tiny), dx, dy, dz);
    if constexpr (viscous) add_velocity(c, b, viscosity_laplacian(u) * volume, drag);
  }
  const Opening<Pack> walls = opening(context, SQUALL_SPIKY, false, first_lanes(block.count()), x, y, z);
  const auto total = [&](Pack pushed, Pack gradient, Pack dragged) {
    Pack force = fma(Pack(p.force_scale), pushed, pressure * gradient);
    if constexpr (viscous) force = fma(Pack(p.viscosity_scale), dragged, force);
    return force / density;
  };
  return {total(push.x, walls.gradient_x, drag.x), total(push.y, walls.gradient_y, drag.y),
          total(push.z, walls.gradient_z, drag.z)};
}

}  // namespace

}  // namespace squall::openmp
